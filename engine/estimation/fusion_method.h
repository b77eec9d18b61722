#pragma once

#include <optional>
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

/// An average of single-sensor estimates, stated so that a search over all sensor sets can build it from the
/// sums of smaller sets, with the bits of fuse().
struct Averaging {
    enum class Weights { equal, by_error };
    /// An estimate at the nodes where it disagrees with the median direction.
    enum class Disagreeing {
        kept,
        left_out,
        left_out_unshared,  ///< its weight is not shared out among the others
    };
    Weights weights = Weights::equal;
    Disagreeing disagreeing = Disagreeing::kept;
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
    bool uses_weights = false;  ///< FusionInput::weight
    /// What fuse() does, for a method that is such an average. A search calls fuse() for every other method.
    std::optional<Averaging> averaging{};
};

// The catalogue: a file and a line for each method, in the order that tables use. Maximum likelihood stands
// before the posterior mean, which overwrites the likelihood.
#define CAPSTAN_FUSION_METHODS(METHOD) \
    METHOD(mean_known_direction)       \
    METHOD(mean_method)                \
    METHOD(mean_r_method)              \
    METHOD(weighted_mean_method)       \
    METHOD(weighted_mean_r_method)     \
    METHOD(maximum_likelihood_method)  \
    METHOD(posterior_mean_method)

#define CAPSTAN_DECLARE(method) extern const FusionMethod method;
CAPSTAN_FUSION_METHODS(CAPSTAN_DECLARE)
#undef CAPSTAN_DECLARE

/// Every method of the catalogue.
const std::vector<FusionMethod>& fusion_methods();
const FusionMethod* find_fusion_method(std::string_view name);

}  // namespace capstan
