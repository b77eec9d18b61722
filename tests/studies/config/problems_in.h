#pragma once

#include <string>
#include <vector>

#include "capstan/config/config_problem.h"
#include "capstan/config/config_reader.h"

namespace capstan::config {

// "2: transmission.segmnets: unknown key; ..." for each problem that `read` finds.
template <typename Read>
std::vector<std::string> problems_of_reading(const Read& read) {
    std::vector<std::string> texts;
    try {
        read();
    } catch (const ConfigError& error) {
        for (const ConfigProblem& problem : error.at_lines())
            texts.push_back(std::to_string(problem.line) + ": " + problem.key + ": " + problem.message);
    }
    return texts;
}

inline std::vector<std::string> problems_in(const std::string& toml) {
    return problems_of_reading([&] { parse_config(toml, "x.toml"); });
}

}  // namespace capstan::config
