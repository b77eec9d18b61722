#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/sensitivity/advice.h"
#include "capstan/sensitivity/morris_design.h"

namespace capstan::sensitivity {

/// The advice at one value of one parameter, the others as configured.
struct ScanPoint {
    double ratio = 1.0;
    std::optional<AdviceThere> there;  ///< nothing: the motion is never in the regime
};

/// The value of one parameter beyond which another layout is better than the configured advice by more than
/// the tolerance.
struct Flip {
    double ratio = 1.0;       ///< the value nearest to the configured one at which it has changed
    double held_ratio = 1.0;  ///< the last value found at which it has not
    AdviceThere there;
};

/// The influence of one parameter.
struct ParameterSensitivity {
    std::string name;
    std::string title;
    std::string unit;
    double value = 0.0;              ///< as configured
    std::vector<double> range;       ///< the smallest and the largest factor
    ElementaryEffects on_regret;     ///< of the configured advice [N]
    ElementaryEffects on_error;      ///< of the best layout there [N]
    std::vector<ScanPoint> scan;     ///< rising, the configured value among them
    std::optional<Flip> flip_below;  ///< nothing: it does not flip within its range
    std::optional<Flip> flip_above;
};

struct SensitivityAnswer {
    std::string noise;
    Advice advice;                                 ///< at the configured values
    IntervalEstimate error;                        ///< its error, on independent draws
    std::vector<ParameterSensitivity> parameters;  ///< those that are uncertain; catalogue order
    int screened = 0;                              ///< sets of parameters of the screening
    int changed = 0;                               ///< the number of those in which the advice has changed
    int never = 0;                  ///< the number of those in which the motion is never in the regime
    double largest_regret_N = 0.0;  ///< of the screened
    int evaluations = 0;
};

struct SensitivityOptions {
    int jobs = 0;  ///< threads; 0: all processors; any number gives the same bits
    int noise_index = 0;
};

/// How the advice at the plan's values performs at other values: a screening of all parameters together, and
/// a scan with bisection along each parameter alone. Throws InvalidInput with what is wrong with the plan.
SensitivityAnswer advice_sensitivity(const StudyPlan& plan, const SensitivityOptions& options);

}  // namespace capstan::sensitivity
