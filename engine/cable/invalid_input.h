#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace capstan {

/// One thing wrong with an input: the key it belongs to, as in a configuration ("regime[2].samples"), and
/// what is wrong with it and what to try.
struct KeyProblem {
    std::string key;
    std::string message;

    std::string text() const { return key + ": " + message; }
    bool operator==(const KeyProblem&) const = default;
};

/// Input that no model can be built from. Lists the problems found, one a line: what is wrong, why it
/// matters, what to try. Of a long list equal problems are counted, and only the first 50 are told.
class InvalidInput : public std::runtime_error {
  public:
    explicit InvalidInput(std::vector<std::string> problems);
    explicit InvalidInput(const std::vector<KeyProblem>& problems);

    const std::vector<std::string>& problems() const { return problems_; }

  private:
    std::vector<std::string> problems_;
};

}  // namespace capstan
