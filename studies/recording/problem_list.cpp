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
    std::vector<std::string> told = problems_;
    if (told.size() > max_listed) {
        told.resize(max_listed);
        told.push_back(fmt::format("and {} problems more", problems_.size() - max_listed));
    }
    throw InvalidInput(told);
}

}  // namespace capstan
