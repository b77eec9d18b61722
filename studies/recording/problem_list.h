#pragma once

#include <string>
#include <vector>

namespace capstan {

/// Collects what is wrong with a recording, so that all of it is said at once.
class ProblemList {
  public:
    void add(const std::string& place, const std::string& problem);
    bool empty() const { return problems_.empty(); }
    /// Throws InvalidInput if anything was added; of a long list the first few and how many follow.
    void throw_if_any() const;

  private:
    std::vector<std::string> problems_;
};

}  // namespace capstan
