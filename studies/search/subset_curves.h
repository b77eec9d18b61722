#pragma once

#include <span>
#include <vector>

#include "capstan/search/error_measure.h"
#include "capstan/search/subset_scores.h"

namespace capstan {

/// The feasible-curve methods on every sensor set of a repetition: a set's log likelihood is that of a
/// smaller set plus one sensor's, kept on a stack while the sets are walked depth first.
class SubsetCurves {
  public:
    /// All arguments must outlive it.
    SubsetCurves(const CandidateList& candidates, const FeasibleCurve& curve,
                 const CurveLikelihood& likelihood, const ErrorMeasure& measure);

    /// Writes the errors of the candidates with these methods.
    void score(std::span<const double> reading_N,  // nodes
               std::span<double> error_N);         // candidates x width

  private:
    void score_maximum_likelihood(std::span<const double> log_likelihood, int peak, double* error_N);

    const CandidateList& candidates_;
    const FeasibleCurve& curve_;
    const CurveLikelihood& likelihood_;
    const ErrorMeasure& measure_;
    std::vector<int> methods_;            // indices of the candidates' methods on the curve
    int maximum_likelihood_ = -1;         // its index among the candidates' methods; -1: not among them
    int stride_ = 0;                      // padded nodes
    std::vector<double> profile_N_;       // points x stride: the curve, what belongs to a point side by side
    std::vector<int> walk_;               // subsets, depth first
    std::vector<double> per_sensor_;      // places x points
    std::vector<double> stack_;           // sizes x points
    std::vector<double> log_likelihood_;  // points: a copy that a method may overwrite
    std::vector<double> tension_N_;       // nodes
};

}  // namespace capstan
