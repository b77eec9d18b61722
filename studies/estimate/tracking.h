#pragma once

#include <functional>
#include <vector>

#include "capstan/estimate/sensed_cable.h"
#include "capstan/estimation/recursive_fusion.h"

namespace capstan::estimate {

/// The assumed errors of the model, the same for every node (E36, E11).
struct ModelTrust {
    double wander_m = 0.0;     ///< of each end in one sample beyond its measured motion, standard deviation
    double error_ratio = 0.0;  ///< of a reading, beyond its noise, in parts of the tension
};

struct TrackingOptions {
    int members = 32;
    std::uint64_t seed = 1;
    int jobs = 1;
};

/// One sample of a run, with the state of the estimator after that sample.
struct TrackedSample {
    std::size_t run = 0;
    std::size_t sample = 0;
    const RecursiveEstimator& estimator;
    /// The same estimator on cables with one number a standard deviation off.
    const std::vector<RecursiveEstimator>& shifted;

    std::size_t nodes() const { return estimator.mean_N().size(); }
    /// With what the uncertain numbers of the cable add to the deviation, each by its own difference.
    RecursiveEstimator::Moments at_node(std::size_t node) const;
    RecursiveEstimator::Moments at(const SensorSpot& spot) const;
};

/// Which channels of a cable the estimator reads, by index.
using ChannelSet = std::vector<std::size_t>;
ChannelSet all_but(const SensedCable& cable, std::span<const std::size_t> left_out);

struct TrackingSummary {
    double log_evidence = 0.0;  ///< of the readings used (E38), all runs
    long unverified = 0;        ///< closed-form steps that did not verify, over members
    long steps = 0;
};

/// Runs the recursive estimator over every run, each from its own pretension, and passes each sample on.
TrackingSummary track(const SensedCable& cable, const ChannelSet& used, const ModelTrust& trust,
                      const TrackingOptions& options,
                      const std::function<void(const TrackedSample&)>& show = {});

/// The work of following a cable once for a band, and of choosing its trust, as track() notes it.
double tracking_work(const SensedCable& cable, const TrackingOptions& options);
double choosing_work(const SensedCable& cable, const TrackingOptions& options);

/// The trust under which the readings used are most likely (E38), from a fixed grid: first the wander, then
/// the error ratio, then the wander again. Looks at no other channel.
ModelTrust likeliest_trust(const SensedCable& cable, const ChannelSet& used, const TrackingOptions& options);

/// RMS of a channel's readings less what one of the paper's methods says there, each step from its own last
/// estimate, from the channels `used`, each read at the node nearest to it. Its cable has the 10 segments of
/// the paper; of channels that share a node the one with the least noise is read.
double paper_rms_N(const SensedCable& cable, const ChannelSet& used, std::size_t predicted,
                   const FusionMethod& method);

}  // namespace capstan::estimate
