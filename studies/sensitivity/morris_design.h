#pragma once

#include <cstdint>
#include <vector>

namespace capstan::sensitivity {

/// Step of a one-at-a-time design on four levels 0, 1/3, 2/3, 1.
inline constexpr double morris_step = 2.0 / 3.0;

/// Walks through the unit cube: each begins at a random point of the grid and moves along every axis once, in
/// a random order (Morris 1991, Technometrics 33:161). Equal arguments give equal walks.
struct MorrisDesign {
    /// trajectories x (axes + 1) x axes
    std::vector<std::vector<std::vector<double>>> points;
    /// trajectories x axes: the axis of each step
    std::vector<std::vector<int>> moved_axis;
};

MorrisDesign morris_design(int trajectories, int axes, std::uint64_t seed);

/// The effect of steps along one axis on a result, in the result's unit over the complete range.
struct ElementaryEffects {
    double mean = 0.0;           ///< mu
    double mean_absolute = 0.0;  ///< mu*: how much the parameter matters (Campolongo et al. 2007)
    double spread = 0.0;         ///< sigma: whether that depends on the others
    int steps = 0;
};

/// `result` is trajectories x (axes + 1); steps from or to a point that is not a number are left out.
std::vector<ElementaryEffects> elementary_effects(const MorrisDesign& design,
                                                  const std::vector<std::vector<double>>& result);

}  // namespace capstan::sensitivity
