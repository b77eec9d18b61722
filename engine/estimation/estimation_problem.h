#pragma once

#include "capstan/cable/cable_state.h"
#include "capstan/solver/quasi_static_step.h"

namespace capstan {

/// What every estimator may know besides readings, and no more: the model, the exact state one step before,
/// and the proximal end's displacement now. What the distal end did is what has to be found out.
struct EstimationProblem {
    const QuasiStaticStep& model;
    const CableState& previous;
    double proximal_displacement_m = 0.0;
};

}  // namespace capstan
