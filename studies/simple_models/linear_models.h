#pragma once

#include "capstan/simple_models/simple_models.h"

namespace capstan::simple_models {

/// Models that are linear in their numbers, by ridge regression: constant, linear, closed form,
/// Prandtl-Ishlinskii times load.
std::vector<SimpleModel> fit_linear_models(const Recording& recording, const ModelledOutput& channels);

/// Elements of fixed stiffness in series with a slider, whose yield grows linearly with the load (E51).
SimpleModel fit_elastic_plastic(const Recording& recording, const ModelledOutput& channels);

/// RMS of measured minus predicted over the scored samples of all runs.
double rms_over(const Recording& recording, const SimpleModel& model);

/// The number of samples of all runs that are scored.
std::size_t scored_samples(const Recording& recording);

}  // namespace capstan::simple_models
