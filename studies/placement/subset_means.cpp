#include "capstan/placement/subset_means.h"

#include <algorithm>

#include "capstan/estimation/fusion_method.h"

namespace capstan {

namespace {

int index_of(const CandidateList& candidates, const FusionMethod& method) {
    for (std::size_t m = 0; m < candidates.methods.size(); ++m) {
        if (candidates.methods[m]->name == method.name) return static_cast<int>(m);
    }
    return -1;
}

}  // namespace

SubsetMeans::SubsetMeans(const CandidateList& candidates, std::span<const double> weight,
                         const ErrorMeasure& measure)
    : candidates_(candidates),
      measure_(measure),
      mean_(index_of(candidates, mean_method)),
      mean_r_(index_of(candidates, mean_r_method)),
      w_mean_(index_of(candidates, weighted_mean_method)),
      w_mean_r_(index_of(candidates, weighted_mean_r_method)),
      votes_(candidates.subsets.usable_nodes()),
      fused_N_(measure.truth_N.size()) {
    if (mean_ >= 0 || mean_r_ >= 0) equal_ = make_sums({});
    if (w_mean_ >= 0 || w_mean_r_ >= 0) weighted_ = make_sums(weight);
}

SubsetMeans::Sums SubsetMeans::make_sums(std::span<const double> weight) const {
    const SensorSubsets& subsets = candidates_.subsets;
    Sums sums;
    for (const int node : subsets.usable_nodes()) sums.factor.push_back(weight.empty() ? 1.0 : weight[node]);
    sums.weight.assign(subsets.count(), 0.0);
    for (int s = 1; s < subsets.count(); ++s) {
        sums.weight[s] = sums.weight[subsets.without_last(s)] + sums.factor[subsets.last_place(s)];
    }
    const std::size_t nodes = measure_.truth_N.size();
    sums.tension_N.assign(subsets.count() * static_cast<std::size_t>(padded_nodes(static_cast<int>(nodes))),
                          0.0);
    sums.mean_error_N.assign(static_cast<std::size_t>(subsets.count()) * measure_.width, 0.0);
    return sums;
}

void SubsetMeans::fill(Sums& sums, const SensorEstimates& estimates) const {
    const SensorSubsets& subsets = candidates_.subsets;
    const int stride = padded_nodes(estimates.nodes);
    for (int s = 1; s < subsets.count(); ++s) {
        const int place = subsets.last_place(s);
        const double factor = sums.factor[place];
        const double* before =
            sums.tension_N.data() + static_cast<std::ptrdiff_t>(subsets.without_last(s)) * stride;
        const double* profile = estimates.padded_profile_N(subsets.usable_nodes()[place]);
        double* here = sums.tension_N.data() + static_cast<std::ptrdiff_t>(s) * stride;
        for (int node = 0; node < stride; ++node) here[node] = before[node] + factor * profile[node];
        const double weight = sums.weight[s];
        measure_.write([&](int node) { return here[node] / weight; },
                       sums.mean_error_N.data() + static_cast<std::ptrdiff_t>(s) * measure_.width);
    }
}

// Mean-R: at each node the average of those who agree there; of all where nobody does.
void SubsetMeans::write_renormalised(int used, double* error_N) const {
    const int stride = padded_nodes(static_cast<int>(measure_.truth_N.size()));
    for (const SubsetVotes::NodeRun& run : runs_) {
        const int agreeing = run.agreeing != 0 ? candidates_.subsets.at(run.agreeing) : used;
        const double* sum_N = equal_.tension_N.data() + static_cast<std::ptrdiff_t>(agreeing) * stride;
        for (int node = run.first; node < run.end; ++node)
            fused_N_[node] = sum_N[node] / equal_.weight[agreeing];
    }
    measure_.write([&](int node) { return fused_N_[node]; }, error_N);
}

// W Mean-R: the weight of those left out is not shared out.
void SubsetMeans::write_reduced(int used, double* error_N) const {
    const int stride = padded_nodes(static_cast<int>(measure_.truth_N.size()));
    for (const SubsetVotes::NodeRun& run : runs_) {
        const int agreeing = run.agreeing != 0 ? candidates_.subsets.at(run.agreeing) : used;
        const double* sum_N = weighted_.tension_N.data() + static_cast<std::ptrdiff_t>(agreeing) * stride;
        for (int node = run.first; node < run.end; ++node)
            fused_N_[node] = sum_N[node] / weighted_.weight[used];
    }
    measure_.write([&](int node) { return fused_N_[node]; }, error_N);
}

void SubsetMeans::score(const SensorEstimates& estimates, std::span<double> error_N) {
    const SensorSubsets& subsets = candidates_.subsets;
    const int width = measure_.width;
    const bool any_equal = mean_ >= 0 || mean_r_ >= 0;
    const bool any_weighted = w_mean_ >= 0 || w_mean_r_ >= 0;
    if (!any_equal && !any_weighted) return;
    votes_.read(estimates);
    if (any_equal) fill(equal_, estimates);
    if (any_weighted) fill(weighted_, estimates);

    for (int s = 1; s < subsets.count(); ++s) {
        const auto slot = [&](int method) {
            return error_N.data() + static_cast<std::ptrdiff_t>(candidates_.of(s, method)) * width;
        };
        const auto wants = [&](int method) {
            return method >= 0 && candidates_.wants(candidates_.of(s, method));
        };
        const std::uint64_t set = subsets.places(s);
        const std::uint64_t used_places = votes_.used(set);
        const int used = used_places == set ? s : subsets.at(used_places);
        const auto plain = [&](const Sums& sums, int method) {
            std::copy_n(sums.mean_error_N.data() + static_cast<std::ptrdiff_t>(used) * width, width,
                        slot(method));
        };
        if (wants(mean_)) plain(equal_, mean_);
        if (wants(w_mean_)) plain(weighted_, w_mean_);
        const bool wants_r = wants(mean_r_);
        const bool wants_wr = wants(w_mean_r_);
        if (!wants_r && !wants_wr) continue;
        if (votes_.alike(set)) {
            if (wants_r) plain(equal_, mean_r_);
            if (wants_wr) plain(weighted_, w_mean_r_);
            continue;
        }
        runs_ = votes_.agreement(set, used_places);
        if (wants_r) write_renormalised(used, slot(mean_r_));
        if (wants_wr) write_reduced(used, slot(w_mean_r_));
    }
}

}  // namespace capstan
