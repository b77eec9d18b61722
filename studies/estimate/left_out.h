#pragma once

#include <vector>

#include "capstan/estimate/tracking.h"

namespace capstan::estimate {

/// How well one channel is predicted by an estimator that never saw it.
struct LeftOutChannel {
    std::size_t channel = 0;
    ModelTrust trust;                 ///< chosen by evidence of the other channels
    double widening = 0.0;            ///< E39, from the other channels only; 0: none or not to be had
    bool widening_known = true;       ///< false: too few channels to leave out two
    double rms_N = 0.0;               ///< of reading less prediction, all samples of all runs
    double model_alone_rms_N = 0.0;   ///< the same without any reading: the model as it is
    double paper_mean_rms_N = 0.0;    ///< the paper's Mean from its own estimates
    double paper_mean_r_rms_N = 0.0;  ///< its Mean-R
    double plain_coverage = 0.0;      ///< fraction of readings within the band without widening
    double coverage = 0.0;            ///< within the band: 1.96 deviations of posterior, widening and noise
    double mean_band_N = 0.0;         ///< half width of that band, mean over samples
    double unverified_fraction = 0.0;
};

/// Leaves each of `channels` out in turn and predicts it from all the others. The widening of a channel's
/// band is taken from the others: each of them is predicted without itself and without that channel, and the
/// model error, in parts of the tension, is what makes 95% of their readings fall within the band (E39). So
/// nothing of a channel goes into its own band. Throws InvalidInput if the cable has fewer than two channels.
std::vector<LeftOutChannel> leave_out(const SensedCable& cable, const std::vector<std::size_t>& channels,
                                      const TrackingOptions& options);

/// What an estimate of the tension everywhere from all channels of a cable uses, chosen by the evidence of
/// these channels.
struct EstimatorTuning {
    ModelTrust trust;
    double widening = 0.0;  ///< E39, each channel predicted without itself
    bool widening_known = true;
};
EstimatorTuning tune_estimator(const SensedCable& cable, const TrackingOptions& options);

/// The work that these two note, for expect_work().
double leave_out_work(const SensedCable& cable, std::size_t channels, const TrackingOptions& options);
double tuning_work(const SensedCable& cable, const TrackingOptions& options);

/// Half width of the 95% band of a tension: posterior deviation and widening.
double band_N(const RecursiveEstimator::Moments& moments, double widening);

}  // namespace capstan::estimate
