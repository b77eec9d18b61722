#include "capstan/config/plan_checks.h"

#include <algorithm>

namespace capstan::config {

namespace {

// What cannot be judged while another key is wrong.
struct Dependence {
    std::string_view key;
    std::string_view on;
};
constexpr Dependence dependences[] = {{.key = "layouts", .on = "transmission.segments"},
                                      {.key = "placement", .on = "transmission.segments"},
                                      {.key = "regime", .on = "motion.samples"},
                                      {.key = "estimation.weights", .on = "regime"}};

bool has_problem_within(const std::vector<ConfigProblem>& known, std::string_view path) {
    return std::any_of(known.begin(), known.end(),
                       [&](const ConfigProblem& problem) { return problem.key.starts_with(path); });
}

// Whether a problem of the values says something new beside the problems of reading them.
bool is_news(const KeyProblem& problem, const std::vector<ConfigProblem>& known) {
    const std::string section = problem.key.substr(0, problem.key.find_first_of(".["));
    if (has_problem_within(known, section)) return false;
    return std::none_of(std::begin(dependences), std::end(dependences), [&](const Dependence& each) {
        return problem.key.starts_with(each.key) && has_problem_within(known, each.on);
    });
}

std::vector<ConfigProblem> at_lines(const KeyLines& lines, const std::vector<KeyProblem>& problems,
                                    const std::vector<ConfigProblem>& known) {
    std::vector<ConfigProblem> placed;
    for (const KeyProblem& problem : problems) {
        if (is_news(problem, known))
            placed.push_back({line_of_key(lines, problem.key), 0, problem.key, problem.message});
    }
    return placed;
}

}  // namespace

std::vector<ConfigProblem> value_problems(const ReadConfig& config, const std::vector<ConfigProblem>& known) {
    return at_lines(config.lines, problems_of_values(config.plan), known);
}

std::vector<ConfigProblem> value_problems(const ReadBench& bench, const std::vector<ConfigProblem>& known) {
    return at_lines(bench.lines, problems_of(bench.plan), known);
}

void require_runnable(const ReadConfig& config) {
    std::vector<ConfigProblem> problems = at_lines(config.lines, problems_of(config.plan), {});
    if (!problems.empty()) throw ConfigError(config.file, std::move(problems));
}

}  // namespace capstan::config
