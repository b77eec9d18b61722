#pragma once

#include <string>

#include "capstan/bench_model/model_prediction.h"

namespace capstan::bench_model {

/// A line for each sample: run, time_s, and for each predicted channel what was measured, what the bench
/// without the diagnosis and the model say of it, and the model with its law where it has one. Names of
/// columns end in the unit. Empty in a run that drives the channel.
std::string prediction_csv(const Recording& recording, const ModelPrediction& prediction);

}  // namespace capstan::bench_model
