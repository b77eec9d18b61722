#include "log_trial.h"

#include <cmath>
#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/log.h"
#include "target.h"
#include "temporary_folder.h"

namespace capstan::fuzz {

namespace {

void demand_consistent(const logs::Log& log) {
    std::set<std::string> tables;
    for (const logs::LogTable& table : log.tables) {
        demand(tables.insert(table.name).second, "tables have different names");
        std::set<std::string> columns;
        for (const logs::LogColumn& column : table.columns) {
            demand(columns.insert(column.name).second, "columns of a table have different names");
            demand(column.name.size() <= 2 * logs::LogLimits::name_bytes, "names are bounded");
            demand(column.values.size() == table.rows, "columns are as long as their table");
            logs::NumberReader reader(column.values);
            for (double number = 0.0; reader.next(number);)
                demand(!std::isinf(number), "a number is finite or missing");
        }
    }
    for (const std::string& remark : log.remarks) demand(!remark.empty(), "a remark says something");
}

}  // namespace

void try_log(const std::uint8_t* data, std::size_t size, std::string_view magic) {
    static const TemporaryFolder folder;
    std::string bytes = text_of(data, size);
    if (bytes.size() >= magic.size()) bytes.replace(0, magic.size(), magic);
    const std::filesystem::path path = folder.write("fuzzed.log", bytes);
    try {
        logs::ReadOptions options;
        options.memory_limit_bytes = 1u << 20;
        demand_consistent(logs::read_log(path, options));
    } catch (const InvalidInput& refusal) {
        demand(std::string_view(refusal.what()).find("fuzzed.log") != std::string_view::npos,
               "a refusal names the file");
    }
}

}  // namespace capstan::fuzz
