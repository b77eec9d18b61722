#pragma once

#include <string>
#include <vector>

#include "capstan/cable/invalid_input.h"

namespace capstan {

/// How uncertain the numbers behind a recommendation are, and which recommendation is asked about. A range is
/// the smallest and the largest factor on the configuration's value; {1, 1} is a number that is certain.
struct SensitivityPlan {
    std::vector<double> friction_ratio = {0.6, 1.5};    ///< conduits wear, and dry out
    std::vector<double> curvature_ratio = {0.7, 1.4};   ///< of every bend: a wearer moves
    std::vector<double> stiffness_ratio = {0.7, 1.4};   ///< of the cable, which beds in
    std::vector<double> pretension_ratio = {0.7, 1.4};  ///< it creeps
    std::vector<double> noise_ratio = {0.5, 2.0};       ///< of what the sensor's data sheet says
    int sensors = 3;
    std::string method = "any";  ///< a fusion method's name, or "any": the one that suits a layout best
    std::string regime = "duty_cycle";  ///< a regime's name, or "duty_cycle"
    double tolerance_N = 0.01;  ///< advice has changed where another layout is better by more than this
    int repetitions = 400;      ///< draws for each set of parameters; as many fresh ones
    int trajectories = 10;      ///< of the screening
};

/// Everything that is wrong with the plan.
std::vector<KeyProblem> problems_of(const SensitivityPlan& plan, int nodes);

}  // namespace capstan
