#include "capstan/recording/problem_list.h"

#include <fmt/format.h>

#include <algorithm>

#include "capstan/cable/invalid_input.h"

namespace capstan {

void ProblemList::add(const std::string& place, const std::string& problem) {
    problems_.push_back({place + ": " + problem, 0});
}

void ProblemList::add_line(const std::string& group, const std::string& place, const std::string& problem) {
    const auto [found, is_new] = groups_.try_emplace(group, problems_.size());
    if (is_new) problems_.push_back({place + ": " + problem, 0});
    ++problems_[found->second].lines;
}

std::vector<std::string> ProblemList::listed(std::size_t limit) const {
    std::vector<std::string> list;
    for (const Problem& problem : problems_) {
        if (list.size() == limit) {
            list.push_back(fmt::format("and {} more problems", problems_.size() - limit));
            break;
        }
        list.push_back(problem.lines > 1
                           ? fmt::format("{} ({} lines, this is the first)", problem.words, problem.lines)
                           : problem.words);
    }
    return list;
}

void ProblemList::throw_if_any() const {
    constexpr std::size_t max_listed = 12;
    if (!problems_.empty()) throw InvalidInput(listed(max_listed));
}

}  // namespace capstan
