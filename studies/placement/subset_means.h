#pragma once

#include <span>
#include <vector>

#include "capstan/placement/error_measure.h"
#include "capstan/placement/subset_scores.h"
#include "capstan/placement/subset_votes.h"

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
    /// Sums over every set, equally or by weight, and the error of their plain averages.
    struct Sums {
        std::vector<double> factor;        // places
        std::vector<double> weight;        // subsets
        std::vector<double> tension_N;     // subsets x padded nodes
        std::vector<double> mean_error_N;  // subsets x width
    };
    Sums make_sums(std::span<const double> weight) const;
    void fill(Sums& sums, const SensorEstimates& estimates) const;
    void write_renormalised(int used, double* error_N) const;
    void write_reduced(int used, double* error_N) const;

    const CandidateList& candidates_;
    const ErrorMeasure& measure_;
    int mean_, mean_r_, w_mean_, w_mean_r_;  // index of the method; -1: not asked for
    Sums equal_;
    Sums weighted_;
    SubsetVotes votes_;
    std::span<const SubsetVotes::NodeRun> runs_;  // of the set at hand
    mutable std::vector<double> fused_N_;         // nodes
};

}  // namespace capstan
