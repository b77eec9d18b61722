#pragma once

#include <string>
#include <vector>

#include "capstan/cable/invalid_input.h"

namespace capstan {

/// The uncertainty of the parameters behind a recommendation, and the recommendation under study. A range is
/// the smallest and the largest factor on the configuration's value; {1, 1} means that the value is certain.
struct SensitivityPlan {
    std::vector<double> friction_ratio = {0.6, 1.5};    ///< conduits wear, and dry out
    std::vector<double> curvature_ratio = {0.7, 1.4};   ///< of every bend: the wearer moves
    std::vector<double> stiffness_ratio = {0.7, 1.4};   ///< of the cable, which beds in
    std::vector<double> pretension_ratio = {0.7, 1.4};  ///< the cable creeps
    std::vector<double> noise_ratio = {0.5, 2.0};       ///< on the value of the sensor's data sheet
    // Of studies over worlds: what is stated of the uncertainty itself.
    std::vector<double> uncertainty_ratio = {0.5, 2.0};        ///< of each [uncertainty] fraction
    std::vector<double> far_end_range_ratio = {0.5, 2.0};      ///< people differ
    std::vector<double> far_end_bandwidth_ratio = {0.5, 2.0};  ///< so do their movements
    int values = 2;  ///< in each range of a study over worlds, spread evenly on a logarithmic scale
    int sensors = 3;
    std::string method = "any";         ///< a fusion method's name, or "any": the best one for each layout
    std::string regime = "duty_cycle";  ///< a regime's name, or "duty_cycle"
    double tolerance_N = 0.01;  ///< advice has changed where another layout is better by more than this
    int repetitions = 400;      ///< draws for each set of parameters; as many independent ones judge
    int trajectories = 10;      ///< of the screening
};

/// Everything that is wrong with the plan.
std::vector<KeyProblem> problems_of(const SensitivityPlan& plan, int nodes);

}  // namespace capstan
