// Prints what read_log makes of each file as one line of JSON, or its refusal: print_log FILE...
#include <cmath>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/log.h"

int main(int count, char** words) {
    using nlohmann::json;
    for (int k = 1; k < count; ++k) {
        json line;
        try {
            const capstan::logs::Log log = capstan::logs::read_log(words[k]);
            line = {{"format", log.format},
                    {"remarks", log.remarks},
                    {"assumptions", log.assumptions},
                    {"tables", json::array()}};
            for (const capstan::logs::LogTable& table : log.tables) {
                json& printed = line["tables"].emplace_back(json{{"name", table.name}, {"rows", table.rows}});
                printed["columns"] = json::array();
                for (const capstan::logs::LogColumn& column : table.columns)
                    printed["columns"].push_back({{"name", column.name},
                                                  {"unit", column.unit},
                                                  {"values", capstan::logs::numbers_of(column.values)}});
            }
        } catch (const capstan::InvalidInput& refusal) {
            line = {{"refusal", refusal.what()}};
        }
        std::cout << line.dump() << std::endl;
    }
}
