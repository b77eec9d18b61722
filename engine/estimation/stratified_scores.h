#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace capstan {

/// The normal distribution in `count` equal shares: the mean of each share's middle, scaled so that their
/// variance is exactly 1. Rising; their mean is 0.
std::vector<double> normal_scores(int count);

/// One draw for each of as many members as there are scores (a power of two): every score once, dealt out
/// by an odd stride from a start, both random.
class StratifiedScores {
  public:
    /// `uniforms`: two numbers in (0, 1).
    StratifiedScores(std::span<const double> scores, const std::array<double, 2>& uniforms)
        : scores_(scores),
          start_(static_cast<std::size_t>(uniforms[0] * static_cast<double>(scores.size()))),
          stride_(2 * static_cast<std::size_t>(uniforms[1] * static_cast<double>(scores.size() / 2)) + 1) {}

    double operator[](std::size_t member) const {
        return scores_[(start_ + stride_ * member) & (scores_.size() - 1)];
    }

  private:
    std::span<const double> scores_;  // members
    std::size_t start_;
    std::size_t stride_;
};

}  // namespace capstan
