#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "capstan/gap/candidate_cause.h"

namespace capstan::gap {

/// Logarithms of friction, stiffness and pretension over their nominal values.
inline constexpr int nominal_coordinates = 3;

/// Causes with their numbers, to be simulated together.
struct Hypothesis {
    std::vector<const CandidateCause*> causes;
    Eigen::VectorXd coordinates;  // the nominal coordinates, then each cause's numbers
};

/// The bench under a hypothesis.
BenchNumbers bench_numbers(const std::vector<const CandidateCause*>& causes,
                           const Eigen::VectorXd& coordinates);

/// The hypothesis with one more cause.
Hypothesis with_cause(Hypothesis present, const CandidateCause* cause, const Eigen::VectorXd& numbers);

/// The hypothesis with only those of its causes that `keep` accepts, at the same numbers.
Hypothesis only_causes(const Hypothesis& hypothesis, const std::function<bool(const CandidateCause&)>& keep);

/// Hypotheses that differ in sensor faults only: one bench is simulated for all of them.
struct SameBench {
    Hypothesis mechanical;
    BenchNumbers numbers;
    std::vector<std::size_t> hypotheses;
};

std::vector<SameBench> by_bench(std::span<const Hypothesis> hypotheses);

/// At most bench_lanes benches. Those that ring are kept apart from those that do not.
using BenchGroup = std::vector<SameBench>;
std::vector<BenchGroup> to_be_moved_at_once(const std::vector<SameBench>& benches);

}  // namespace capstan::gap
