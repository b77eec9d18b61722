#include "capstan/cli/config_problem.h"

#include <algorithm>
#include <utility>

namespace capstan::cli {

namespace {

std::string in_lines(const std::string& file, const std::vector<ConfigProblem>& problems) {
    std::string text;
    for (const ConfigProblem& problem : problems) {
        if (!text.empty()) text += "\n";
        text += file;
        if (problem.line > 0) text += ":" + std::to_string(problem.line);
        if (problem.column > 0) text += ":" + std::to_string(problem.column);
        text += ": " + (problem.key.empty() ? "" : problem.key + ": ") + problem.message;
    }
    return text;
}

std::vector<ConfigProblem> by_line(std::vector<ConfigProblem> problems) {
    std::stable_sort(problems.begin(), problems.end(), [](const ConfigProblem& a, const ConfigProblem& b) {
        return std::pair(a.line, a.column) < std::pair(b.line, b.column);
    });
    return problems;
}

}  // namespace

bool sound(const std::vector<ConfigProblem>& known, std::string_view path) {
    return std::none_of(known.begin(), known.end(),
                        [&](const ConfigProblem& problem) { return problem.key.starts_with(path); });
}

ConfigError::ConfigError(const std::string& file, std::vector<ConfigProblem> problems)
    : UsageError(in_lines(file, by_line(problems))), problems_(by_line(std::move(problems))) {}

}  // namespace capstan::cli
