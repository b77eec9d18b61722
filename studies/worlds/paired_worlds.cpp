#include "capstan/worlds/paired_worlds.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

namespace capstan {

namespace {

// Enough for Student's t to be near the normal, few enough for a quantile of what is left.
constexpr std::size_t blocks = 20;

}  // namespace

Estimated mean_of(const std::vector<double>& values, double alpha) {
    const double count = static_cast<double>(values.size());
    double mean = 0.0;
    for (const double value : values) mean += value / count;
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    const double error = std::sqrt(squares / (count - 1.0) / count);
    const boost::math::students_t student(count - 1.0);
    const double half = boost::math::quantile(boost::math::complement(student, 0.5 * alpha)) * error;
    return {mean, mean - half, mean + half};
}

double quantile_of(std::vector<double> values, double fraction) {
    std::sort(values.begin(), values.end());
    const double at = fraction * (static_cast<double>(values.size()) - 1.0);
    const auto below = static_cast<std::size_t>(at);
    if (below + 1 >= values.size()) return values.back();
    return values[below] + (at - static_cast<double>(below)) * (values[below + 1] - values[below]);
}

double fall_near(double at_N, const std::vector<double>& from_N, const std::vector<double>& to_N) {
    const double count = static_cast<double>(from_N.size());
    double error_N = 0.0;
    double fall_N = 0.0;
    for (std::size_t w = 0; w < from_N.size(); ++w) {
        error_N += 0.5 * (from_N[w] + to_N[w]) / count;  // of both, so that chance in one tilts nothing
        fall_N += (from_N[w] - to_N[w]) / count;
    }
    double along = 0.0;
    double squares = 0.0;
    for (std::size_t w = 0; w < from_N.size(); ++w) {
        const double off_N = 0.5 * (from_N[w] + to_N[w]) - error_N;
        along += off_N * (from_N[w] - to_N[w] - fall_N);
        squares += off_N * off_N;
    }
    return fall_N + (squares > 0.0 ? along / squares * (at_N - error_N) : 0.0);
}

std::vector<double> contributions(PlacementObjective objective, const std::vector<double>& values) {
    if (objective != PlacementObjective::quantile_95 || values.size() < 2 * blocks) return values;
    const double all = quantile_of(values, 0.95);
    std::vector<double> pseudo;
    for (std::size_t block = 0; block < blocks; ++block) {
        std::vector<double> others;
        for (std::size_t world = 0; world < values.size(); ++world)
            if (world % blocks != block) others.push_back(values[world]);
        const double without = quantile_of(std::move(others), 0.95);
        pseudo.push_back(static_cast<double>(blocks) * all - (static_cast<double>(blocks) - 1.0) * without);
    }
    return pseudo;
}

std::vector<double> differences(std::vector<double> a, const std::vector<double>& b) {
    for (std::size_t k = 0; k < a.size(); ++k) a[k] -= b[k];
    return a;
}

}  // namespace capstan
