#include "capstan/estimation/stratified_scores.h"

#include <cmath>
#include <numbers>

namespace capstan {

namespace {

// The normal quantile by Newton's method on erfc; a few dozen numbers, made once.
double normal_quantile(double fraction) {
    double score = 0.0;
    for (int iteration = 0; iteration < 60; ++iteration) {
        const double below = 0.5 * std::erfc(-score / std::numbers::sqrt2);
        const double density = std::exp(-0.5 * score * score) / std::sqrt(2.0 * std::numbers::pi);
        // Half a unit at most: far out the density is too small for a full step.
        const double step = std::fmin(std::fmax((fraction - below) / density, -0.5), 0.5);
        score += step;
        if (std::abs(step) < 1e-14) break;
    }
    return score;
}

}  // namespace

std::vector<double> normal_scores(int count) {
    std::vector<double> scores(static_cast<std::size_t>(count));
    double squares = 0.0;
    for (int k = 0; k < (count + 1) / 2; ++k) {
        const double score = 2 * k + 1 == count ? 0.0 : normal_quantile((k + 0.5) / count);
        scores[static_cast<std::size_t>(k)] = score;
        scores[static_cast<std::size_t>(count - 1 - k)] = -score;
        squares += (2 * k + 1 == count ? 1.0 : 2.0) * score * score;
    }
    for (double& score : scores) score *= std::sqrt(count / squares);
    return scores;
}

}  // namespace capstan
