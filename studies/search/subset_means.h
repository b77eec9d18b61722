#pragma once

#include <span>
#include <vector>

#include "capstan/search/error_measure.h"
#include "capstan/search/subset_scores.h"
#include "capstan/search/subset_sums.h"
#include "capstan/search/subset_votes.h"

namespace capstan {

/// The paper's fusion methods (Mean, Mean-R, W Mean, W Mean-R) on every sensor set of a repetition. Which
/// sensors of a set are used, and where they agree, is again a set: so the sums over all sets are made once,
/// and every fused tension is one of them divided by a weight. Same bits as the methods give one by one.
class SubsetMeans {
  public:
    /// All arguments must outlive it.
    SubsetMeans(const CandidateList& candidates, std::span<const double> weight, const ErrorMeasure& measure);

    /// Writes the errors of the candidates with these methods.
    void score(const SensorEstimates& estimates, std::span<double> error_N);  // candidates x width

  private:
    void write_average(const SubsetSums& sums, int used, double* error_N) const;
    void gather(const double* rows_N, int stride);
    void write_renormalised(double* error_N);
    void write_reduced(int used, double* error_N);

    const CandidateList& candidates_;
    const ErrorMeasure& measure_;
    int mean_, mean_r_, w_mean_, w_mean_r_;  // index of the method; -1: not among them
    std::vector<double> truth_N_;            // padded nodes
    SubsetSums equal_;
    SubsetSums weighted_;
    SubsetVotes votes_;
    std::span<const SubsetVotes::NodeRun> runs_;  // of the set at hand
    std::vector<int> agreeing_;                   // runs: the set whose sensors agree there
    std::vector<double> fused_N_;                 // nodes, and room for a group of four beyond
};

}  // namespace capstan
