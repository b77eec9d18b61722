#pragma once

#include <string>
#include <vector>

#include "capstan/worlds/world_study.h"

namespace capstan::sensitivity {

/// What a study over worlds advises where one of its stated numbers is another.
struct AdviceWhere {
    double ratio = 1.0;          ///< on the stated number
    WorldAnswer answer;          ///< without what is said beside the recommendation
    Expected advised_as_stated;  ///< of the sensors that the stated numbers advise, in these worlds
    Estimated loss;              ///< they - the best of their price here, paired
    bool changes =
        false;  ///< another price is advised, or a set of that price is better by more than the resolution
};

struct VariedNumber {
    std::string name;   ///< "far_end_range", ... as in [sensitivity]
    std::string title;  ///< for people
    std::string unit;   ///< of `value`; empty: none
    double value = 0.0;
    std::vector<AdviceWhere> where;  ///< rising

    bool changes() const;
};

struct WorldSensitivity {
    WorldAnswer stated;  ///< without what is said beside the recommendation
    std::vector<VariedNumber> numbers;
};

/// The advice with each stated number of a study over worlds varied alone, over the ranges of
/// plan.sensitivity; the estimator is told the varied number. Throws InvalidInput with problems_of(plan), and
/// TableStopped.
WorldSensitivity vary_worlds(const StudyPlan& plan, const TableOptions& options);

}  // namespace capstan::sensitivity
