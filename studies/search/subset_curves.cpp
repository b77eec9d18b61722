#include "capstan/search/subset_curves.h"

#include <algorithm>

#include "capstan/estimation/curve_peak.h"
#include "capstan/estimation/sensor_vote.h"

namespace capstan {

SubsetCurves::SubsetCurves(const CandidateList& candidates, const FeasibleCurve& curve,
                           const CurveLikelihood& likelihood, const ErrorMeasure& measure)
    : candidates_(candidates), curve_(curve), likelihood_(likelihood), measure_(measure) {
    for (std::size_t m = 0; m < candidates.methods.size(); ++m) {
        if (candidates.methods[m]->knowledge == Knowledge::feasible_curve)
            methods_.push_back(static_cast<int>(m));
        if (candidates.methods[m]->name == maximum_likelihood_method.name)
            maximum_likelihood_ = static_cast<int>(m);
    }
    // Sets that are wanted, and those that they begin with.
    const SensorSubsets& subsets = candidates.subsets;
    std::vector<std::uint8_t> needed(subsets.count(), 0);
    for (int s = subsets.count() - 1; s > 0; --s) {
        for (const int method : methods_) needed[s] |= candidates.wants(candidates.of(s, method));
        needed[subsets.without_last(s)] |= needed[s];
    }
    for (const int s : subsets.depth_first()) {
        if (needed[s]) walk_.push_back(s);
    }
    const std::size_t points = curve.points();
    per_sensor_.resize(candidates.subsets.usable_nodes().size() * points);
    stack_.resize((candidates.subsets.max_sensors() + 1) * points, 0.0);
    log_likelihood_.resize(points);
    stride_ = padded_nodes(curve.nodes());
    tension_N_.resize(stride_);
    profile_N_.resize(points * stride_, 0.0);
    for (int node = 0; node < curve.nodes(); ++node) {
        const auto along_N = curve.tension_N(node);
        for (std::size_t k = 0; k < points; ++k) profile_N_[k * stride_ + node] = along_N[k];
    }
}

// maximum_likelihood_around() on profiles whose nodes lie side by side.
void SubsetCurves::score_maximum_likelihood(std::span<const double> log_likelihood, int peak,
                                            double* error_N) {
    const CurvePlace place = likeliest_place(log_likelihood, peak);
    const double* here_N = profile_N_.data() + static_cast<std::ptrdiff_t>(place.point) * stride_;
    const double* there_N = profile_N_.data() + static_cast<std::ptrdiff_t>(place.neighbour) * stride_;
    double* tension_N = tension_N_.data();
    for (int node = 0; node < stride_; ++node)
        tension_N[node] = here_N[node] + place.fraction * (there_N[node] - here_N[node]);
    measure_.write([tension_N](int node) { return tension_N[node]; }, error_N);
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
    const auto row = [&](std::vector<double>& rows, int index) {
        return std::span<double>(rows).subspan(index * points, points);
    };
    FusionInput input;
    input.curve = &curve_;
    input.log_likelihood = log_likelihood_;
    const std::span<double> fused_N = std::span<double>(tension_N_).first(curve_.nodes());
    for (const int s : walk_) {
        const int size = subsets.sensors(s);
        const std::span<double> here = row(stack_, size);
        const int peak = add_log_likelihood_and_find_peak(row(stack_, size - 1),
                                                          row(per_sensor_, subsets.last_place(s)), here);
        for (const int method : methods_) {
            const int candidate = candidates_.of(s, method);
            if (!candidates_.wants(candidate)) continue;
            double* const slot = error_N.data() + static_cast<std::ptrdiff_t>(candidate) * measure_.width;
            if (method == maximum_likelihood_) {
                score_maximum_likelihood(here, peak, slot);
                continue;
            }
            std::copy(here.begin(), here.end(), log_likelihood_.begin());
            candidates_.methods[method]->fuse(input, fused_N);
            measure_.write([&](int node) { return tension_N_[node]; }, slot);
        }
    }
}

}  // namespace capstan
