#include "capstan/cli/runnable_config.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "capstan/cli/config_problem.h"

namespace capstan::cli {

namespace {

// A message of the study begins with the path of what it speaks of, "layouts.counts: ..." or "regime mass:
// ...". 0 where that does not stand in the file.
int line_spoken_of(const std::string& message, const ReadConfig& config) {
    const auto line_of = [&](const std::string& path) {
        const auto line = config.lines.find(path);
        return line == config.lines.end() ? 0 : line->second;
    };
    for (std::size_t k = 0; k < config.plan.regimes.size(); ++k) {
        const std::string subject = fmt::format("regime {}", name_of(config.plan.regimes[k].regime));
        const bool is_subject = message.starts_with(subject + ":") || message.starts_with(subject + " ");
        if (is_subject) return line_of(fmt::format("regime[{}].samples", k + 1));
    }
    const std::string subject = message.substr(0, message.find_first_of(": "));
    if (message.compare(subject.size(), 2, ": ") == 0) {  // perhaps "transmission: segments is 0"
        const std::string rest = message.substr(subject.size() + 2);
        const int line = line_of(subject + "." + rest.substr(0, rest.find_first_of(": ")));
        if (line != 0) return line;
    }
    return line_of(subject);
}

}  // namespace

void require_runnable(const ReadConfig& config) {
    std::vector<ConfigProblem> problems;
    for (const std::string& message : problems_of(config.plan)) {
        problems.push_back({line_spoken_of(message, config), 0, "", message});
    }
    if (!problems.empty()) throw ConfigError(config.file, std::move(problems));
}

}  // namespace capstan::cli
