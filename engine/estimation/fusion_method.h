#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "capstan/estimation/feasible_curve.h"
#include "capstan/estimation/sensor_vote.h"

namespace capstan {

/// What a method must be told, or is allowed to use.
enum class Knowledge {
    direction_known,    ///< the true direction of every segment
    direction_unknown,  ///< nothing: single-sensor estimates vote on it
    feasible_curve,     ///< nothing: readings are likelihoods along the curve of feasible states
};

std::string_view name_of(Knowledge knowledge);

/// All that fusing one set of sensors in one repetition may look at. Prepared once for all methods; a field
/// that no chosen method needs may be empty.
struct FusionInput {
    std::span<const int> sensors;  // sensors of the set, rising
    SensorEstimates known;         ///< under the true direction; `verified` 0: the sensor's node rests
    SensorEstimates unknown;
    std::span<const double> weight;    // nodes: of each sensor, any positive scale
    const SensorVote* vote = nullptr;  ///< of `unknown` over `sensors`
    const FeasibleCurve* curve = nullptr;
    std::span<double> log_likelihood;  // points: of all readings of the set; may be overwritten
};

/// One way to turn the readings of several sensors into tensions at all nodes.
struct FusionMethod {
    std::string_view name;
    std::string_view title;
    Knowledge knowledge;
    std::string_view meaning;
    std::string_view source;
    /// Writes the tension of every node [N].
    void (*fuse)(const FusionInput& input, std::span<double> tension_N);
};

/// Every method, in the order that tables use. Maximum likelihood stands before the posterior mean, which
/// overwrites the likelihood.
const std::vector<FusionMethod>& fusion_methods();
const FusionMethod* find_fusion_method(std::string_view name);

// One file each.
extern const FusionMethod mean_known_direction;
extern const FusionMethod mean_method;
extern const FusionMethod mean_r_method;
extern const FusionMethod weighted_mean_method;
extern const FusionMethod weighted_mean_r_method;
extern const FusionMethod maximum_likelihood_method;
extern const FusionMethod posterior_mean_method;

}  // namespace capstan
