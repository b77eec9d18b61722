#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace capstan {

/// Input that no model can be built from. Lists every problem found, one a line: what is wrong, why it
/// matters, what to try.
class InvalidInput : public std::runtime_error {
  public:
    explicit InvalidInput(std::vector<std::string> problems);

    const std::vector<std::string>& problems() const { return problems_; }

  private:
    std::vector<std::string> problems_;
};

}  // namespace capstan
