#include "capstan/placement/subset_curves.h"

#include <algorithm>

namespace capstan {

SubsetCurves::SubsetCurves(const CandidateList& candidates, const FeasibleCurve& curve,
                           const CurveLikelihood& likelihood, const ErrorMeasure& measure)
    : candidates_(candidates), curve_(curve), likelihood_(likelihood), measure_(measure) {
    for (std::size_t m = 0; m < candidates.methods.size(); ++m) {
        if (candidates.methods[m]->knowledge == Knowledge::feasible_curve)
            methods_.push_back(static_cast<int>(m));
    }
    const std::size_t points = curve.points();
    per_sensor_.resize(candidates.subsets.usable_nodes().size() * points);
    stack_.resize((candidates.subsets.most_sensors() + 1) * points, 0.0);
    log_likelihood_.resize(points);
    tension_N_.resize(measure.truth_N.size());
}

void SubsetCurves::score(std::span<const double> reading_N, std::span<double> error_N) {
    if (methods_.empty()) return;
    const SensorSubsets& subsets = candidates_.subsets;
    const std::vector<int>& nodes = subsets.usable_nodes();
    const std::size_t points = curve_.points();
    for (std::size_t p = 0; p < nodes.size(); ++p) {
        likelihood_.log_likelihood(nodes[p], reading_N[nodes[p]],
                                   std::span<double>(per_sensor_).subspan(p * points, points));
    }
    FusionInput input;
    input.curve = &curve_;
    input.log_likelihood = log_likelihood_;
    for (const int s : subsets.depth_first()) {
        const int size = subsets.sensors(s);
        const double* before = stack_.data() + (size - 1) * points;
        const double* last = per_sensor_.data() + subsets.last_place(s) * points;
        double* here = stack_.data() + size * points;
        for (std::size_t k = 0; k < points; ++k) here[k] = before[k] + last[k];
        for (const int method : methods_) {
            const int candidate = candidates_.of(s, method);
            if (!candidates_.wants(candidate)) continue;
            std::copy_n(here, points, log_likelihood_.data());
            candidates_.methods[method]->fuse(input, tension_N_);
            measure_.write([&](int node) { return tension_N_[node]; },
                           error_N.data() + static_cast<std::ptrdiff_t>(candidate) * measure_.width);
        }
    }
}

}  // namespace capstan
