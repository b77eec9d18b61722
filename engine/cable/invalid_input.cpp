#include "capstan/cable/invalid_input.h"

#include <map>
#include <utility>

namespace capstan {

namespace {

std::string one_a_line(const std::vector<std::string>& problems) {
    std::string text;
    for (const std::string& problem : problems) {
        text += text.empty() ? problem : "\n" + problem;
    }
    return text;
}

std::vector<std::string> texts_of(const std::vector<KeyProblem>& problems) {
    std::vector<std::string> texts;
    for (const KeyProblem& problem : problems) texts.push_back(problem.text());
    return texts;
}

constexpr std::size_t max_listed = 50;

// A long list has equal problems once, with their number, and then the number of the others.
std::vector<std::string> summary_of(std::vector<std::string> problems) {
    if (problems.size() <= max_listed) return problems;
    std::map<std::string, std::size_t> times;
    std::vector<std::string> first;
    for (std::string& problem : problems)
        if (++times[problem] == 1) first.push_back(std::move(problem));
    std::vector<std::string> list;
    for (std::size_t k = 0; k < first.size() && k < max_listed; ++k) {
        const std::size_t count = times[first[k]];
        list.push_back(count == 1 ? first[k] : first[k] + " (" + std::to_string(count) + " times)");
    }
    if (first.size() > max_listed)
        list.push_back("and " + std::to_string(first.size() - max_listed) + " more problems");
    return list;
}

}  // namespace

InvalidInput::InvalidInput(std::vector<std::string> problems)
    : std::runtime_error(one_a_line(problems = summary_of(std::move(problems)))),
      problems_(std::move(problems)) {}

InvalidInput::InvalidInput(const std::vector<KeyProblem>& problems) : InvalidInput(texts_of(problems)) {}

}  // namespace capstan
