#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/bench_model/bench_model.h"
#include "capstan/estimate/sensed_cable.h"

namespace capstan::estimate {

/// The cables of a recording as a model of its bench describes them.
struct ModelledCables {
    std::vector<SensedCable> cables;
    /// What the model has and the estimator cannot use, in words: "pulley friction", "sensor lag (tension
    /// 1)".
    std::vector<std::string> not_used;
};

/// What an estimator takes from a model beside friction, stiffness and pretension.
struct UsedParts {
    std::span<const std::string_view> effects{};
    bool zeros_and_gains = false;                      ///< of sensors
    bool conditions = false;                           ///< numbers that follow a condition of the runs
    std::span<const std::string> stated_conditions{};  ///< else: friction and pretension that follow these
    double sample_rate_Hz = 0.0;                       ///< of what it reads; 0: not known
};

/// What the model has beyond that, in words, as ModelledCables::not_used.
std::vector<std::string> parts_not_used(const bench_model::BenchModel& model, const UsedParts& used);

/// As sensed_cables(), with the model's friction (also viscous and Stribeck), stiffness, pretension, wrap of
/// local bends and drift, and what follows a condition of the runs; readings without the zero and gain of
/// their sensors. The intervals of friction, stiffness, pretension, viscous drag and Stribeck's extra
/// friction are what is uncertain of the cables. Throws InvalidInput as sensed_cables(), and for a model of
/// unknown geometry or of another kind of bench.
ModelledCables modelled_cables(const Recording& recording, const bench_model::BenchModel& model,
                               int segments);

/// The path with more wrap over a stretch; what lies beyond the ends of the cable is left out. Lengths in
/// metres, angle in radians.
std::vector<CurvaturePiece> with_bend(const std::vector<CurvaturePiece>& path, double from_m, double to_m,
                                      double extra_angle_rad);

}  // namespace capstan::estimate
