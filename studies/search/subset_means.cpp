#include "capstan/search/subset_means.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>

namespace capstan {

namespace {

bool any_score_wanted(const CandidateList& candidates, int method) {
    for (int s = 1; s < candidates.subsets.count(); ++s) {
        if (candidates.wants(candidates.of(s, method))) return true;
    }
    return false;
}

}  // namespace

SubsetMeans::SubsetMeans(const CandidateList& candidates, std::span<const double> weight,
                         const ErrorMeasure& measure)
    : candidates_(candidates),
      weight_(weight),
      measure_(measure),
      truth_N_(measure.truth_N.begin(), measure.truth_N.end()),
      votes_(candidates.subsets.usable_nodes()),
      fused_N_(measure.truth_N.size() + 4) {
    truth_N_.resize(padded_nodes(static_cast<int>(measure.truth_N.size())), 0.0);
    for (int m = 0; m < static_cast<int>(candidates.methods.size()); ++m) {
        const FusionMethod& method = *candidates.methods[m];
        if (method.knowledge == Knowledge::direction_known)
            throw std::logic_error(std::string(method.name) + ": a search cannot know the true direction");
        if (method.knowledge == Knowledge::feasible_curve || !any_score_wanted(candidates, m)) continue;
        if (method.averaging) {
            averaged_.push_back({m, sums_for(*method.averaging), method.averaging->disagreeing});
        } else {
            fused_one_by_one_.push_back(m);
        }
    }
}

SubsetSums SubsetMeans::new_sums(std::vector<double> factor, Averages averages) const {
    return make_subset_sums(candidates_.subsets, std::move(factor), static_cast<int>(measure_.truth_N.size()),
                            averages);
}

// The sums with a method's weights, made for the first method that needs them.
const SubsetSums* SubsetMeans::sums_for(const Averaging& averaging) {
    const std::vector<int>& nodes = candidates_.subsets.usable_nodes();
    switch (averaging.weights) {
        case Averaging::Weights::equal:
            if (equal_.factor.empty())
                equal_ = new_sums(std::vector<double>(nodes.size(), 1.0), Averages::keep);
            return &equal_;
        case Averaging::Weights::by_error: {
            const bool keep = measure_.width > 1 || averaging.disagreeing == Averaging::Disagreeing::left_out;
            if (weighted_.factor.empty() || (keep && weighted_.average_N.empty())) {
                std::vector<double> factor;
                for (const int node : nodes) factor.push_back(weight_[node]);
                weighted_ = new_sums(std::move(factor), keep ? Averages::keep : Averages::leave_out);
            }
            return &weighted_;
        }
    }
    return nullptr;
}

double* SubsetMeans::slot(std::span<double> error_N, int subset, int method) const {
    return error_N.data() + static_cast<std::ptrdiff_t>(candidates_.of(subset, method)) * measure_.width;
}

void SubsetMeans::write_average(const SubsetSums& sums, int used, double* error_N) const {
    if (measure_.width == 1) {
        *error_N = sums.mean_abs_N[used];
        return;
    }
    const double* average_N = sums.average_of(used);
    measure_.write([&](int node) { return average_N[node]; }, error_N);
}

// For each run of nodes the set whose sensors agree there; all where none does.
void SubsetMeans::find_agreement(std::uint64_t set, int used, std::uint64_t used_places) {
    runs_ = votes_.agreement(set, used_places);
    agreeing_.clear();
    for (const SubsetVotes::NodeRun& run : runs_)
        agreeing_.push_back(run.agreeing != 0 ? candidates_.subsets.at(run.agreeing) : used);
}

// Of each run the row of its set, four nodes at a time: the surplus that is written beyond a run belongs to
// the next one, which comes later.
void SubsetMeans::gather(const double* rows_N, int stride) {
    double* fused_N = fused_N_.data();
    for (std::size_t k = 0; k < runs_.size(); ++k) {
        const double* row_N = rows_N + static_cast<std::ptrdiff_t>(agreeing_[k]) * stride;
        for (int node = runs_[k].first; node < runs_[k].end; node += 4)
            std::memcpy(fused_N + node, row_N + node, 4 * sizeof(double));
    }
}

void SubsetMeans::write_agreeing(const Averaged& averaged, int used, double* error_N) {
    const SubsetSums& sums = *averaged.sums;
    const double* fused_N = fused_N_.data();
    if (averaged.disagreeing == Averaging::Disagreeing::left_out) {
        gather(sums.average_N.data(), sums.stride);
        measure_.write([fused_N](int node) { return fused_N[node]; }, error_N);
        return;
    }
    gather(sums.tension_N.data(), sums.stride);
    const double weight = sums.weight[used];
    measure_.write([fused_N, weight](int node) { return fused_N[node] / weight; }, error_N);
}

void SubsetMeans::score_averages(int subset, std::span<double> error_N) {
    const auto wanted = [&](const Averaged& each) { return wants(subset, each.method); };
    if (std::none_of(averaged_.begin(), averaged_.end(), wanted)) return;
    const std::uint64_t set = candidates_.subsets.places(subset);
    const std::uint64_t used_places = votes_.used(set);
    const int used = used_places == set ? subset : candidates_.subsets.at(used_places);
    bool all_agree = true;
    const bool any_leaves_out = std::any_of(averaged_.begin(), averaged_.end(), [&](const Averaged& each) {
        return each.disagreeing != Averaging::Disagreeing::kept && wanted(each);
    });
    if (any_leaves_out && !votes_.alike(set)) {
        all_agree = false;
        find_agreement(set, used, used_places);
    }
    for (const Averaged& each : averaged_) {
        if (!wanted(each)) continue;
        if (all_agree || each.disagreeing == Averaging::Disagreeing::kept) {
            write_average(*each.sums, used, slot(error_N, subset, each.method));
        } else {
            write_agreeing(each, used, slot(error_N, subset, each.method));
        }
    }
}

void SubsetMeans::score_one_by_one(int subset, const SensorEstimates& estimates, std::span<double> error_N) {
    const std::vector<int> sensors = candidates_.subsets.nodes_of(subset);
    const SensorVote vote = take_vote(estimates, sensors);
    FusionInput input;
    input.sensors = sensors;
    input.unknown = estimates;
    input.weight = weight_;
    input.vote = &vote;
    for (const int method : fused_one_by_one_) {
        if (!wants(subset, method)) continue;
        candidates_.methods[method]->fuse(input, std::span<double>(fused_N_).first(measure_.truth_N.size()));
        measure_.write([&](int node) { return fused_N_[node]; }, slot(error_N, subset, method));
    }
}

void SubsetMeans::score(const SensorEstimates& estimates, std::span<double> error_N) {
    if (averaged_.empty() && fused_one_by_one_.empty()) return;
    const SensorSubsets& subsets = candidates_.subsets;
    votes_.read(estimates);
    std::vector<const double*> profile_N;
    for (const int node : subsets.usable_nodes()) profile_N.push_back(estimates.padded_profile_N(node));
    for (SubsetSums* sums : {&equal_, &weighted_}) {
        if (!sums->factor.empty()) fill_subset_sums(subsets, profile_N, truth_N_, measure_.fraction, *sums);
    }
    for (int s = 1; s < subsets.count(); ++s) {
        score_averages(s, error_N);
        if (!fused_one_by_one_.empty()) score_one_by_one(s, estimates, error_N);
    }
}

}  // namespace capstan
