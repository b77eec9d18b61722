#pragma once

#include <span>
#include <string>
#include <vector>

#include "capstan/gap/cause_fit.h"
#include "capstan/gap/evidence.h"
#include "capstan/recording/recording.h"

namespace capstan::gap {

/// A recording that could be made next on the same bench.
struct Experiment {
    std::string kind;  ///< "protocol": another motion; "sensor": the same motion with one more sensor
    std::string name;
    std::string description;
    /// One run with its driven channels filled in. The other channels are zero.
    Recording recording;
};

/// Motions that stay within the torque and angle that the recording shows, more pretension, a later session,
/// and a tension sensor at five places along each cable.
std::vector<Experiment> possible_experiments(const Recording& recording);

/// How well an experiment would distinguish the members of a group.
struct ExperimentScore {
    std::string kind;
    std::string name;
    std::string description;
    /// Probability of naming the right one of the two most similar members, if both are equally likely
    /// before: 0.5 is a guess.
    double discrimination_probability = 0.5;
};

/// Explanations that a recording cannot distinguish, and experiments that would.
struct NonIdentifiable {
    std::vector<std::vector<std::string>> group;  ///< effects of each explanation, most probable first
    std::vector<ExperimentScore> experiments;     ///< most decisive first; empty if none helps
    /// None of the group is probable: a cause outside the list is. They are those that come closest.
    bool is_unknown = false;
};

/// The explanations that compete with the leading one: each has a probability of at least 0.05, while the
/// first has less than 0.95. Where a cause outside the list is more probable than not, those of the listed
/// that come closest to it, because an experiment in which they differ shows in what way each is wrong. At
/// most three; empty if the recording decides.
std::vector<WeighedHypothesis> non_identifiable(std::span<const WeighedHypothesis> weighed);

/// Whether a cause outside the list is more probable than not.
bool is_probably_unknown(std::span<const WeighedHypothesis> weighed);

/// Simulates every possible experiment with each explanation as it was fitted. A rival explanation may change
/// all its numbers, within what the recording allows, to reproduce the outcome. The part of the outcome that
/// it cannot reproduce, in units of noise and floor over the independent samples, distinguishes the two.
/// `fitter`: of the recording.
NonIdentifiable discriminating_experiments(const Recording& recording, const CauseFitter& fitter,
                                           std::span<const WeighedHypothesis> group, int threads);

}  // namespace capstan::gap
