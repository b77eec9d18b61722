#include "capstan/search/subset_means.h"

#include <algorithm>
#include <cstring>

#include "capstan/estimation/fusion_method.h"

namespace capstan {

namespace {

// The index of a method of which any score is wanted.
int index_of(const CandidateList& candidates, const FusionMethod& method) {
    for (std::size_t m = 0; m < candidates.methods.size(); ++m) {
        if (candidates.methods[m]->name != method.name) continue;
        for (int s = 1; s < candidates.subsets.count(); ++s) {
            if (candidates.wants(candidates.of(s, static_cast<int>(m)))) return static_cast<int>(m);
        }
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
      truth_N_(measure.truth_N.begin(), measure.truth_N.end()),
      votes_(candidates.subsets.usable_nodes()),
      fused_N_(measure.truth_N.size() + 4) {
    const SensorSubsets& subsets = candidates.subsets;
    const int nodes = static_cast<int>(truth_N_.size());
    truth_N_.resize(padded_nodes(nodes), 0.0);
    if (mean_ >= 0 || mean_r_ >= 0) {
        equal_ = make_subset_sums(subsets, std::vector<double>(subsets.usable_nodes().size(), 1.0), nodes,
                                  Averages::keep);
    }
    if (w_mean_ >= 0 || w_mean_r_ >= 0) {
        std::vector<double> factor;
        for (const int node : subsets.usable_nodes()) factor.push_back(weight[node]);
        weighted_ = make_subset_sums(subsets, std::move(factor), nodes,
                                     measure.width > 1 ? Averages::keep : Averages::leave_out);
    }
}

void SubsetMeans::write_average(const SubsetSums& sums, int used, double* error_N) const {
    if (measure_.width == 1) {
        *error_N = sums.mean_abs_N[used];
        return;
    }
    const double* average_N = sums.average_of(used);
    measure_.write([&](int node) { return average_N[node]; }, error_N);
}

// Of each run the row of its set, four nodes at a time: what is written beyond a run is the next one's, which
// comes later.
void SubsetMeans::gather(const double* rows_N, int stride) {
    double* fused_N = fused_N_.data();
    for (std::size_t k = 0; k < runs_.size(); ++k) {
        const double* row_N = rows_N + static_cast<std::ptrdiff_t>(agreeing_[k]) * stride;
        for (int node = runs_[k].first; node < runs_[k].end; node += 4)
            std::memcpy(fused_N + node, row_N + node, 4 * sizeof(double));
    }
}

// Mean-R: at each node the average of those who agree there; of all where nobody does.
void SubsetMeans::write_renormalised(double* error_N) {
    gather(equal_.average_N.data(), equal_.stride);
    const double* fused_N = fused_N_.data();
    measure_.write([fused_N](int node) { return fused_N[node]; }, error_N);
}

// W Mean-R: the weight of those left out is not shared out.
void SubsetMeans::write_reduced(int used, double* error_N) {
    gather(weighted_.tension_N.data(), weighted_.stride);
    const double* fused_N = fused_N_.data();
    const double weight = weighted_.weight[used];
    measure_.write([fused_N, weight](int node) { return fused_N[node] / weight; }, error_N);
}

void SubsetMeans::score(const SensorEstimates& estimates, std::span<double> error_N) {
    const SensorSubsets& subsets = candidates_.subsets;
    const bool any_equal = mean_ >= 0 || mean_r_ >= 0;
    const bool any_weighted = w_mean_ >= 0 || w_mean_r_ >= 0;
    if (!any_equal && !any_weighted) return;
    votes_.read(estimates);
    std::vector<const double*> profile_N;
    for (const int node : subsets.usable_nodes()) profile_N.push_back(estimates.padded_profile_N(node));
    if (any_equal) fill_subset_sums(subsets, profile_N, truth_N_, measure_.fraction, equal_);
    if (any_weighted) fill_subset_sums(subsets, profile_N, truth_N_, measure_.fraction, weighted_);

    for (int s = 1; s < subsets.count(); ++s) {
        const auto slot = [&](int method) {
            return error_N.data() + static_cast<std::ptrdiff_t>(candidates_.of(s, method)) * measure_.width;
        };
        const auto wants = [&](int method) {
            return method >= 0 && candidates_.wants(candidates_.of(s, method));
        };
        const bool wants_r = wants(mean_r_);
        const bool wants_wr = wants(w_mean_r_);
        if (!wants(mean_) && !wants(w_mean_) && !wants_r && !wants_wr) continue;
        const std::uint64_t set = subsets.places(s);
        const std::uint64_t used_places = votes_.used(set);
        const int used = used_places == set ? s : subsets.at(used_places);
        if (wants(mean_)) write_average(equal_, used, slot(mean_));
        if (wants(w_mean_)) write_average(weighted_, used, slot(w_mean_));
        if (!wants_r && !wants_wr) continue;
        if (votes_.alike(set)) {
            if (wants_r) write_average(equal_, used, slot(mean_r_));
            if (wants_wr) write_average(weighted_, used, slot(w_mean_r_));
            continue;
        }
        runs_ = votes_.agreement(set, used_places);
        agreeing_.clear();
        for (const SubsetVotes::NodeRun& run : runs_)
            agreeing_.push_back(run.agreeing != 0 ? subsets.at(run.agreeing) : used);
        if (wants_r) write_renormalised(slot(mean_r_));
        if (wants_wr) write_reduced(used, slot(w_mean_r_));
    }
}

}  // namespace capstan
