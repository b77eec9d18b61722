#include "capstan/config/config_problem.h"

#include <algorithm>
#include <utility>

namespace capstan::config {

namespace {

std::string in_one_line(const std::string& file, const ConfigProblem& problem) {
    std::string text = file;
    if (problem.line > 0) text += ":" + std::to_string(problem.line);
    if (problem.column > 0) text += ":" + std::to_string(problem.column);
    return text + ": " + (problem.key.empty() ? "" : problem.key + ": ") + problem.message;
}

std::vector<std::string> in_lines(const std::string& file, const std::vector<ConfigProblem>& problems) {
    std::vector<std::string> lines;
    for (const ConfigProblem& problem : problems) lines.push_back(in_one_line(file, problem));
    return lines;
}

std::vector<ConfigProblem> by_line(std::vector<ConfigProblem> problems) {
    std::stable_sort(problems.begin(), problems.end(), [](const ConfigProblem& a, const ConfigProblem& b) {
        return std::pair(a.line, a.column) < std::pair(b.line, b.column);
    });
    return problems;
}

}  // namespace

ConfigError::ConfigError(const std::string& file, std::vector<ConfigProblem> problems)
    : InvalidInput(in_lines(file, by_line(problems))), problems_(by_line(std::move(problems))) {}

int line_of_key(const KeyLines& lines, std::string key) {
    while (true) {
        if (const auto line = lines.find(key); line != lines.end()) return line->second;
        const std::size_t end = key.find_last_of(".[");
        if (end == std::string::npos) return 0;
        key.resize(end);
    }
}

}  // namespace capstan::config
