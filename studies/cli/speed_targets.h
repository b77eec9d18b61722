#pragma once

#include <string>
#include <vector>

namespace capstan::cli {

/// A speed that the step shall reach, and what was measured in this run.
struct SpeedTarget {
    std::string what;
    std::string unit;
    double target = 0.0;
    double measured = 0.0;
    bool at_least = true;  ///< else at most

    bool met() const { return at_least ? measured >= target : measured <= target; }
    /// How much of the target is missing, as a fraction of it.
    double short_by() const {
        return met() ? 0.0 : at_least ? 1.0 - measured / target : measured / target - 1.0;
    }
};

/// One line a target: what was measured, what it shall be, and how far off it is.
std::string in_words(const std::vector<SpeedTarget>& targets);

}  // namespace capstan::cli
