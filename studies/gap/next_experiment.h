#pragma once

#include <span>
#include <string>
#include <vector>

#include "capstan/gap/cause_fit.h"
#include "capstan/gap/evidence.h"
#include "capstan/recording/recording.h"

namespace capstan::gap {

/// What a laboratory could record next on the same bench.
struct Experiment {
    std::string kind;  ///< "protocol": another motion; "sensor": the same motion with one more sensor
    std::string name;
    std::string description;
    /// One run with its driven channels filled in; what the bench would answer is zero.
    Recording recording;
};

/// Motions that stay within the torque and angle that the recording shows, more pretension, a later session,
/// and a tension sensor at five places along each cable.
std::vector<Experiment> possible_experiments(const Recording& recording);

/// How well an experiment would tell the members of a group apart.
struct ExperimentScore {
    std::string kind;
    std::string name;
    std::string description;
    /// That the right one of the two most alike is found, if each is as likely before: 0.5 is a guess.
    double discrimination_probability = 0.5;
};

/// Explanations that a recording cannot tell apart, and what would.
struct NonIdentifiable {
    std::vector<std::vector<std::string>> group;  ///< effects of each explanation, most probable first
    std::vector<ExperimentScore> experiments;     ///< most telling first; empty if nothing helps
};

/// The known explanations that share the leader's probability: each with at least a twentieth, while the
/// first has less than 0.95. At most three; empty if the recording decides.
std::vector<WeighedHypothesis> non_identifiable(std::span<const WeighedHypothesis> weighed);

/// Simulates every possible experiment with each explanation as it was fitted; another explanation may move
/// all its numbers, as far as the recording at hand lets it, to imitate what comes out. What it cannot
/// imitate, in units of noise and floor over the independent samples, tells the two apart.
/// `fitter`: of the recording at hand.
NonIdentifiable discriminating_experiments(const Recording& recording, const CauseFitter& fitter,
                                           std::span<const WeighedHypothesis> group, int threads);

}  // namespace capstan::gap
