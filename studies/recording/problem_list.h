#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace capstan {

/// Collects the problems of a recording, so that all of them are reported at once.
class ProblemList {
  public:
    void add(const std::string& place, const std::string& problem);
    /// A problem that many lines have: it is told once, at its first place, with the number of lines. `group`
    /// is what the lines have in common.
    void add_line(const std::string& group, const std::string& place, const std::string& problem);
    bool empty() const { return problems_.empty(); }
    std::size_t size() const { return problems_.size(); }
    /// Each as "place: problem"; at most `limit`, and then the number of the others.
    std::vector<std::string> listed(std::size_t limit) const;
    /// Throws InvalidInput if anything was added. A long list is cut, and the number of the others is given.
    void throw_if_any() const;

  private:
    struct Problem {
        std::string words;
        std::size_t lines = 0;  ///< 0: it is not counted
    };
    std::vector<Problem> problems_;
    std::map<std::string, std::size_t> groups_;
};

}  // namespace capstan
