#include "capstan/sensitivity/morris_design.h"

#include <cmath>
#include <numeric>
#include <random>

namespace capstan::sensitivity {

MorrisDesign morris_design(int trajectories, int axes, std::uint64_t seed) {
    std::mt19937_64 random(seed);  // its raw numbers are the same everywhere, unlike distributions
    MorrisDesign design;
    for (int t = 0; t < trajectories; ++t) {
        std::vector<double> point(axes);
        for (double& x : point) x = static_cast<double>(random() % 4) / 3.0;
        std::vector<int> order(axes);
        std::iota(order.begin(), order.end(), 0);
        for (int k = axes - 1; k > 0; --k) std::swap(order[k], order[random() % (k + 1)]);
        std::vector<std::vector<double>> walk = {point};
        for (const int axis : order) {
            point[axis] += point[axis] < 0.5 ? morris_step : -morris_step;
            walk.push_back(point);
        }
        design.points.push_back(std::move(walk));
        design.moved_axis.push_back(std::move(order));
    }
    return design;
}

std::vector<ElementaryEffects> elementary_effects(const MorrisDesign& design,
                                                  const std::vector<std::vector<double>>& result) {
    const int axes = design.moved_axis.empty() ? 0 : static_cast<int>(design.moved_axis.front().size());
    std::vector<ElementaryEffects> all(axes);
    for (int axis = 0; axis < axes; ++axis) {
        std::vector<double> effects;
        for (std::size_t t = 0; t < design.points.size(); ++t) {
            for (int k = 0; k < axes; ++k) {
                if (design.moved_axis[t][k] != axis) continue;
                const double step = design.points[t][k + 1][axis] - design.points[t][k][axis];
                const double effect = (result[t][k + 1] - result[t][k]) / step;
                if (std::isfinite(effect)) effects.push_back(effect);
            }
        }
        ElementaryEffects& sum = all[axis];
        sum.steps = static_cast<int>(effects.size());
        for (const double effect : effects) {
            sum.mean += effect / sum.steps;
            sum.mean_absolute += std::abs(effect) / sum.steps;
        }
        for (const double effect : effects) sum.spread += (effect - sum.mean) * (effect - sum.mean);
        sum.spread = sum.steps > 1 ? std::sqrt(sum.spread / (sum.steps - 1)) : 0.0;
    }
    return all;
}

}  // namespace capstan::sensitivity
