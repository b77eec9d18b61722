#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "capstan/gap/candidate_cause.h"

namespace capstan::gap {

/// Whether two sets hold the same causes, in whichever order these were found.
bool are_same_causes(const std::vector<const CandidateCause*>& one,
                     const std::vector<const CandidateCause*>& other);

/// Whether these causes are that there is none.
bool is_nothing(const std::vector<const CandidateCause*>& causes);

/// Causes with their numbers, to be simulated together.
struct Hypothesis {
    std::vector<const CandidateCause*> causes;
    Eigen::VectorXd coordinates;  // the bench's floating numbers, then each cause's numbers
    const BenchKnowledge* bench = &measured_bench();
};

/// A bench without a cause, all of its numbers as they are stated.
Hypothesis nominal_hypothesis(const BenchKnowledge& bench);

/// The bench under a hypothesis.
BenchNumbers bench_numbers(const Hypothesis& hypothesis);

/// The hypothesis with one more cause.
Hypothesis with_cause(Hypothesis present, const CandidateCause* cause, const Eigen::VectorXd& numbers);

/// The hypothesis with only those of its causes that `keep` accepts, at the same numbers.
Hypothesis only_causes(const Hypothesis& hypothesis, const std::function<bool(const CandidateCause&)>& keep);

/// The hypothesis without each of its causes in turn.
std::vector<Hypothesis> without_each(const Hypothesis& hypothesis);

/// Hypotheses that differ in one run in what sensors read: one bench is simulated for all of them.
struct SameBench {
    MovedBench moved;  // without faults of sensors
    std::vector<std::size_t> hypotheses;
};

/// `run`: index of a run of the recording.
std::vector<SameBench> by_bench(std::span<const Hypothesis> hypotheses, const Recording& recording,
                                std::size_t run);

/// At most bench_lanes benches of any runs, long runs first. Benches that ring are kept apart from those that
/// do not.
using BenchGroup = std::vector<SameBench>;
std::vector<BenchGroup> to_be_moved_at_once(std::vector<SameBench> benches, const Recording& recording);

}  // namespace capstan::gap
