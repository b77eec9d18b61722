#include "capstan/recording/problem_list.h"

#include <fmt/format.h>

#include "capstan/cable/invalid_input.h"

namespace capstan {

void ProblemList::add(const std::string& place, const std::string& problem) {
    problems_.push_back(place + ": " + problem);
}

void ProblemList::throw_if_any() const {
    constexpr std::size_t max_listed = 12;
    if (problems_.empty()) return;
    std::vector<std::string> listed = problems_;
    if (listed.size() > max_listed) {
        listed.resize(max_listed);
        listed.push_back(fmt::format("and {} more problems", problems_.size() - max_listed));
    }
    throw InvalidInput(listed);
}

}  // namespace capstan
