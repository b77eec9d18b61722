#pragma once
// The paper's estimation experiment (its Sec. III.C): 10 segments, distal end blocked, proximal end moved by
// 1 cm at 1 Hz, 100 samples a second, the paper's reading of its model.

#include <cmath>
#include <numbers>
#include <vector>

#include "capstan/estimation/estimation_problem.h"
#include "capstan/sensing/noise.h"
#include "example_cables.h"

namespace capstan::test {

inline const QuasiStaticStep& paper_step() {
    static const QuasiStaticStep step(paper_cable(10), ModelRules::paper());
    return step;
}

/// The instants of the paper's figures: mass motion forward and backward, and partial motion up to node 8.
inline constexpr int mass_samples[] = {112, 142};
inline constexpr int partial_samples[] = {6, 104};

/// A sample of the experiment and the one before.
struct Instant {
    const QuasiStaticStep& step;
    CableState previous;
    CableState truth;

    EstimationProblem problem() const { return {step, previous, truth.displacement_m.front()}; }
    int nodes() const { return step.cable().nodes(); }
    double mean_tension_N() const {
        double sum_N = 0.0;
        for (const double tension_N : truth.tension_N) sum_N += tension_N;
        return sum_N / nodes();
    }
};

inline Instant instant_of(const QuasiStaticStep& step, int sample) {
    CableState now = pretensioned(step.cable());
    CableState previous = now;
    const double rest_m = now.displacement_m.front();
    for (int n = 1; n <= sample; ++n) {
        previous = now;
        const double proximal_m = rest_m + 0.01 * std::sin(2.0 * std::numbers::pi * n / 100.0);
        step.advance(now, {EndCondition::position_m(proximal_m), EndCondition::position_m(0.0)});
    }
    return {step, previous, now};
}

inline Instant paper_instant(int sample) {
    return instant_of(paper_step(), sample);
}

/// Readings of all nodes with 10% noise.
inline constexpr NoiseLevel ten_percent{0.1, 0.0, 0.0};
inline std::vector<double> noisy_readings(const Instant& instant, int sample, int repetition) {
    const ReadingDraws draws = draw_readings(
        {1, static_cast<std::uint32_t>(sample), static_cast<std::uint32_t>(repetition)}, instant.nodes());
    std::vector<double> reading_N(instant.nodes());
    read_tensions(ten_percent, draws, instant.truth.tension_N, reading_N);
    return reading_N;
}

/// Mean over nodes of the absolute error [N].
inline double mean_abs_error_N(const std::vector<double>& tension_N, const std::vector<double>& truth_N) {
    double sum_N = 0.0;
    for (std::size_t node = 0; node < truth_N.size(); ++node)
        sum_N += std::abs(tension_N[node] - truth_N[node]);
    return sum_N / static_cast<double>(truth_N.size());
}

}  // namespace capstan::test
