#include "capstan/placement/sensor_weights.h"

#include <algorithm>

namespace capstan {

namespace {

// A sensor that never errs gets a very large weight, not an infinite one.
constexpr double smallest_error_N = 1e-12;

}  // namespace

bool gives_weights(const PreparedStudy& study, int source_index, int fused_index) {
    const Regime source = study.scenarios[source_index].regime;
    switch (study.plan.weight_source) {
        case WeightSource::mass_motion:
            return source == Regime::mass;
        case WeightSource::same_regime:
            return source == study.scenarios[fused_index].regime;
    }
    return false;
}

std::vector<double> sensor_weights(const PreparedStudy& study,
                                   const std::vector<std::vector<double>>& errors_N, int scenario_index) {
    std::vector<double> mean_N(study.nodes(), 0.0);
    int sources = 0;
    for (int s = 0; s < static_cast<int>(study.scenarios.size()); ++s) {
        if (!gives_weights(study, s, scenario_index)) continue;
        for (int node = 0; node < study.nodes(); ++node) mean_N[node] += errors_N[s][node];
        ++sources;
    }
    // Without a source no W method is in the plan; any weights will do.
    if (sources == 0) return std::vector<double>(study.nodes(), 1.0);
    std::vector<double> weight;
    for (const double sum_N : mean_N) weight.push_back(1.0 / std::max(sum_N / sources, smallest_error_N));
    return weight;
}

}  // namespace capstan
