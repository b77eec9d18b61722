#pragma once

#include <span>
#include <vector>

#include "capstan/estimation/fusion_method.h"
#include "capstan/search/error_measure.h"
#include "capstan/search/subset_scores.h"
#include "capstan/search/subset_sums.h"
#include "capstan/search/subset_votes.h"

namespace capstan {

/// The fusion methods that average single-sensor estimates, on every sensor set of a repetition. Which
/// sensors of a set are used, and where they agree, is again a set: so the sums over all sets are made once,
/// and every fused tension of a method with an Averaging is one of them divided by a weight, with the bits of
/// its fuse(). A method without an Averaging is fused set by set.
class SubsetMeans {
  public:
    /// All arguments must outlive it. Throws std::logic_error for a method that must know the direction,
    /// which no candidate can.
    SubsetMeans(const CandidateList& candidates, std::span<const double> weight, const ErrorMeasure& measure);
    SubsetMeans(const SubsetMeans&) = delete;
    SubsetMeans& operator=(const SubsetMeans&) = delete;

    /// Writes the errors of the candidates with these methods.
    void score(const SensorEstimates& estimates, std::span<double> error_N);  // candidates x width

  private:
    /// A candidates' method that is an average.
    struct Averaged {
        int method = 0;
        const SubsetSums* sums = nullptr;
        Averaging::Disagreeing disagreeing = Averaging::Disagreeing::kept;
    };
    const SubsetSums* sums_for(const Averaging& averaging);
    SubsetSums new_sums(std::vector<double> factor, Averages averages) const;
    void score_averages(int subset, std::span<double> error_N);
    void score_one_by_one(int subset, const SensorEstimates& estimates, std::span<double> error_N);
    bool wants(int subset, int method) const { return candidates_.wants(candidates_.of(subset, method)); }
    double* slot(std::span<double> error_N, int subset, int method) const;
    void write_average(const SubsetSums& sums, int used, double* error_N) const;
    void find_agreement(std::uint64_t set, int used, std::uint64_t used_places);
    void gather(const double* rows_N, int stride);
    void write_agreeing(const Averaged& averaged, int used, double* error_N);

    const CandidateList& candidates_;
    std::span<const double> weight_;  // nodes
    const ErrorMeasure& measure_;
    std::vector<double> truth_N_;  // padded nodes
    SubsetSums equal_;
    SubsetSums weighted_;
    std::vector<Averaged> averaged_;
    std::vector<int> fused_one_by_one_;  // indices of the candidates' methods
    SubsetVotes votes_;
    std::span<const SubsetVotes::NodeRun> runs_;  // of the set at hand
    std::vector<int> agreeing_;                   // runs: the set whose sensors agree there
    std::vector<double> fused_N_;                 // nodes, and space for a group of four beyond
};

}  // namespace capstan
