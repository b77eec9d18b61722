#include "capstan/cable/invalid_input.h"

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

}  // namespace

InvalidInput::InvalidInput(std::vector<std::string> problems)
    : std::runtime_error(one_a_line(problems)), problems_(std::move(problems)) {}

InvalidInput::InvalidInput(const std::vector<KeyProblem>& problems) : InvalidInput(texts_of(problems)) {}

}  // namespace capstan
