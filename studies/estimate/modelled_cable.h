#pragma once

#include <string>
#include <vector>

#include "capstan/bench_model/bench_model.h"
#include "capstan/estimate/sensed_cable.h"

namespace capstan::estimate {

/// The cables of a recording as a model of its bench describes them.
struct ModelledCables {
    std::vector<SensedCable> cables;
    /// What the model has and the estimator cannot use, in words: "viscous friction", "sensor lag (tension
    /// 1)".
    std::vector<std::string> not_used;
};

/// As sensed_cables(), with the model's friction, stiffness, pretension, wrap of local bends and drift, and
/// what follows a condition of the runs; readings without the zero and gain of their sensors. The intervals
/// of friction, stiffness and pretension are what is uncertain of the cables. Throws InvalidInput as
/// sensed_cables(), and for a model of unknown geometry or of another kind of bench.
ModelledCables modelled_cables(const Recording& recording, const bench_model::BenchModel& model,
                               int segments);

/// The path with more wrap over a stretch; what lies beyond the ends of the cable is left out. Lengths in
/// metres, angle in radians.
std::vector<CurvaturePiece> with_bend(const std::vector<CurvaturePiece>& path, double from_m, double to_m,
                                      double extra_angle_rad);

}  // namespace capstan::estimate
