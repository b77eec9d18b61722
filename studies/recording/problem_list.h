#pragma once

#include <string>
#include <vector>

namespace capstan {

/// Collects the problems of a recording, so that all of them are reported at once.
class ProblemList {
  public:
    void add(const std::string& place, const std::string& problem);
    bool empty() const { return problems_.empty(); }
    /// Throws InvalidInput if anything was added. A long list is cut, and the number of the others is given.
    void throw_if_any() const;

  private:
    std::vector<std::string> problems_;
};

}  // namespace capstan
