#pragma once

#include <vector>

#include "capstan/estimation/fusion_method.h"
#include "capstan/worlds/world.h"

namespace capstan {

/// How far an estimate was from the truth in one world, over all of its samples.
struct WorldError {
    double mean_abs_N = 0.0;        ///< over samples and the cable's length
    double load_end_N = 0.0;        ///< mean absolute error at the distal node, of a pair at both
    double worst_place_N = 0.0;     ///< of the node where the mean absolute error is largest
    double mean_square_N2 = 0.0;    ///< over samples and the cable's length
    double covered_fraction = 0.0;  ///< of the truth, over the same, that lies within the estimate's 95% band
    std::vector<double> node_abs_N{};  // cables x nodes: mean absolute error over samples

    bool operator==(const WorldError&) const = default;
};

/// The ensemble filter with these sensors (indices of the question's offers) over a world.
WorldError filter_error(const WorldQuestion& question, const CableBelief& belief, const World& world,
                        const EnsembleDraws& draws, std::span<const int> sensors);

/// One of the paper's four methods over a world of a single cable, from its own last estimate and with the
/// nominal cable. It needs a tension sensor, and takes each to be at the nearest node. `weight`: of each
/// offer, for the W methods.
WorldError paper_error(const WorldQuestion& question, const World& world, std::span<const int> sensors,
                       const FusionMethod& method, std::span<const double> weight = {});

/// The weight of a tension sensor in the W methods: 1 / the mean error [1/N] of its own estimate over time,
/// in worlds that are drawn for nothing else.
double paper_weight(const WorldQuestion& question, int sensor);

/// The members' draws of a world.
EnsembleDraws ensemble_draws(const WorldQuestion& question, std::uint32_t world);

}  // namespace capstan
