#pragma once

#include <vector>

#include "capstan/bench_model/bench_model.h"

namespace capstan::bench_model {

/// What the model says of the parameters that a calibration fits, by their names there, with their intervals.
/// Empty for a band, which has no calibration.
std::vector<FittedNumber> calibration_numbers(const BenchModel& model);

}  // namespace capstan::bench_model
