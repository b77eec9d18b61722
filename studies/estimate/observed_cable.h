#pragma once

#include <map>
#include <string>
#include <vector>

#include "capstan/bench_model/bench_model.h"
#include "capstan/estimation/recursive_estimator.h"

namespace capstan::estimate {

/// The state of the bench in which a cable of it is observed.
struct ObservedBench {
    BentCables cable = BentCables::only_a;       ///< which of a pair; a single cable is A
    double pretension_N = 0.0;                   ///< as the bench is said to have; the model corrects it
    double session_s = 0.0;                      ///< since the session began, for a pretension that drifts
    std::map<std::string, double> conditions{};  ///< by name, for numbers that follow one; else its middle
    int segments = 40;
    bool speed_dependent = true;  ///< whether friction that depends on the sliding speed is used
};

/// A cable of a model as an observer takes it.
struct ObservedCable {
    CableSpecification specification;
    RateFriction rate_friction;
    std::vector<std::string> not_used;  ///< what the model has beyond that, in words, as parts_not_used()
};

/// The cable with the model's friction (also viscous and Stribeck), stiffness, pretension and its drift, wrap
/// of a local bend, and what follows the stated conditions. Of a bench of unknown geometry it is a cable of
/// the equivalent bench.
ObservedCable observed_cable(const bench_model::BenchModel& model, const ObservedBench& bench);

}  // namespace capstan::estimate
