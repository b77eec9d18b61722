#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/plan/study_plan.h"
#include "capstan/search/placement_scope.h"

namespace capstan::sensitivity {

/// A layout and how its readings are fused.
struct Advice {
    std::vector<int> nodes;  // from 0
    std::string method;
    bool operator==(const Advice&) const = default;
};

/// The best advice under one set of parameters, and the cost of keeping other advice.
struct AdviceThere {
    Advice best;
    IntervalEstimate best_error;  ///< on independent draws, 95%
    /// Error of the given advice less that of the best, paired, on independent draws: below zero only by
    /// chance.
    IntervalEstimate regret;
};

/// The question about an advice; its count, method and regime come from plan.sensitivity.
class AdviceQuestion {
  public:
    /// Throws InvalidInput with what is wrong, or if there are too many layouts to score under many sets of
    /// parameters. `plan` must outlive it.
    AdviceQuestion(const StudyPlan& plan, int noise_index);

    /// The best under the parameters (factors, one for each of uncertain_parameters()) and the regret of
    /// `given` there; without it, of the best itself. The same draws whatever the parameters. Nothing if
    /// the motion is never in the regime of the question. Works on one thread.
    std::optional<AdviceThere> ask(const std::vector<double>& ratio, const Advice* given) const;

  private:
    const StudyPlan& plan_;
    int noise_index_;
};

}  // namespace capstan::sensitivity
