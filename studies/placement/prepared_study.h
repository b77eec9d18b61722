#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capstan/estimation/feasible_curve.h"
#include "capstan/estimation/fusion_method.h"
#include "capstan/estimation/single_sensor.h"
#include "capstan/plan/study_plan.h"

namespace capstan {

/// One instant of the true motion, with what every estimator derives from the state before it once and for
/// all.
struct PreparedScenario {
    Regime regime = Regime::mass;
    int sample = 0;
    CableState previous;
    CableState truth;
    SingleSensorEstimator estimator;
    std::vector<std::optional<SensorBranch>> known_branch;  // nodes; empty: the node rests
    FeasibleCurve curve;
};

/// A layout and which of the distinct sensor sets it names.
struct PlannedLayout {
    Layout layout;
    int set_index = 0;
};

/// A plan with everything computed that does not depend on a draw.
struct PreparedStudy {
    const StudyPlan& plan;
    QuasiStaticStep step;
    std::vector<PreparedScenario> scenarios;  // regimes in plan order, their samples in plan order
    std::vector<PlannedLayout> layouts;
    std::vector<std::vector<int>> sensor_sets;  // distinct, in order of first use
    std::vector<const FusionMethod*> methods;   // in catalogue order

    int nodes() const { return step.cable().nodes(); }
    int cells() const { return static_cast<int>(sensor_sets.size() * methods.size()); }
    bool uses(Knowledge knowledge) const;
};

/// Throws InvalidInput with problems_of(plan). The plan must outlive the result.
PreparedStudy prepare(const StudyPlan& plan);

/// The error of a study at instants without any sensor [N]: of the mean of the feasible states (E10), whose
/// prior is flat, averaged over the nodes and over a regime's instants. By the regime's name; "duty_cycle"
/// weighs the regimes. No draw is needed. Throws InvalidInput with problems_of(plan).
std::map<std::string, double> no_sensor_errors_N(const StudyPlan& plan);

}  // namespace capstan
