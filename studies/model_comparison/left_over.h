#pragma once

#include <vector>

#include "capstan/model_comparison/bench_predictions.h"
#include "capstan/residual_law/residual_law.h"
#include "capstan/simple_models/modelled_output.h"

namespace capstan::model_comparison {

/// What a corrected model leaves of a channel, and the law of it.
struct LeftOver {
    simple_models::ModelledOutput channels;
    residual_law::ResidualNames names;
    residual_law::ResidualLaw law;
};

/// The driving channels of a run, and what `predictions` leaves of the output.
residual_law::ResidualRun residual_run(const Recording& recording, std::size_t run,
                                       const simple_models::ModelledOutput& channels,
                                       const Predictions& predictions);

/// Fits a law to each channel that is predicted in every run and that no run drives. Where several choices of
/// motion and load are possible, the one whose law leaves least is taken.
std::vector<LeftOver> fit_left_over(const Recording& recording, const Predictions& predictions);

/// The predictions of the channel with the law of what they leave; without a law the same. Runs x samples;
/// empty for runs that drive the channel.
std::vector<std::vector<double>> with_law(const Recording& recording, const Predictions& corrected,
                                          const LeftOver& left);

}  // namespace capstan::model_comparison
