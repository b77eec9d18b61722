#pragma once

#include <optional>
#include <vector>

#include "capstan/estimation/direction_pattern.h"
#include "capstan/estimation/estimation_problem.h"

namespace capstan {

/// A number that depends on the reading z as constant + per_reading * z.
struct Affine {
    double constant = 0.0;
    double per_reading = 0.0;
};

/// Tension and displacement of every node under an assumed pattern, for any reading z at one node.
struct PatternProfile {
    std::vector<Affine> tension_N;       // nodes
    std::vector<Affine> displacement_m;  // nodes
};

/// Solves a pattern with E1, E2, the proximal displacement, and the reading in place of E3 on the sensor's
/// side. Empty if the sensor's node rests under the pattern.
std::optional<PatternProfile> pattern_profile(const EstimationProblem& problem,
                                              const DirectionPattern& pattern, int sensor);

/// Readings for which the pattern verifies: open interval, empty when low_N >= high_N.
struct ReadingInterval {
    double low_N;
    double high_N;
};
ReadingInterval verified_readings(const EstimationProblem& problem, const DirectionPattern& pattern,
                                  const PatternProfile& profile);

}  // namespace capstan
