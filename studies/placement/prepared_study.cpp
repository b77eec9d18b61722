#include "capstan/placement/prepared_study.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "capstan/cable/invalid_input.h"
#include "capstan/plan/true_motion.h"

namespace capstan {

namespace {

struct Sampled {
    CableState previous;
    CableState truth;
};

std::map<int, Sampled> simulate_instants(const StudyPlan& plan) {
    std::map<int, Sampled> instants;
    for (const RegimeInstants& regime : plan.regimes) {
        for (const int sample : regime.samples) instants[sample];
    }
    simulate_truth(plan, [&](int sample, const CableState& previous, const CableState& now) {
        const auto wanted = instants.find(sample);
        if (wanted != instants.end()) wanted->second = {previous, now};
    });
    return instants;
}

PreparedScenario prepare_scenario(const QuasiStaticStep& step, const StudyPlan& plan, Regime regime,
                                  int sample, const Sampled& at) {
    const EstimationProblem problem{step, at.previous, at.truth.displacement_m.front()};
    std::vector<std::optional<SensorBranch>> known;
    for (int node = 0; node < step.cable().nodes(); ++node) {
        known.push_back(known_direction_branch(problem, at.truth.last_motion, node));
    }
    return {regime,
            sample,
            at.previous,
            at.truth,
            SingleSensorEstimator(problem, plan.distal_side, plan.pattern_order),
            std::move(known),
            FeasibleCurve(problem, {plan.largest_distal_increment_m, plan.curve_points})};
}

std::vector<Layout> all_layouts(const StudyPlan& plan, int nodes) {
    std::vector<Layout> layouts;
    for (const std::string& name : plan.layout_families) {
        for (const int count : plan.sensor_counts) {
            for (Layout& layout : find_layout_family(name)->layouts(count, nodes)) {
                layouts.push_back(std::move(layout));
            }
        }
    }
    for (const std::vector<int>& explicit_nodes : plan.explicit_layouts) {
        layouts.push_back(explicit_layout(explicit_nodes));
    }
    return layouts;
}

}  // namespace

bool PreparedStudy::uses(Knowledge knowledge) const {
    return std::any_of(methods.begin(), methods.end(),
                       [&](const FusionMethod* method) { return method->knowledge == knowledge; });
}

PreparedStudy prepare(const StudyPlan& plan) {
    if (const auto problems = problems_of(plan); !problems.empty()) throw InvalidInput(problems);
    PreparedStudy study{
        plan, QuasiStaticStep(Cable(plan.transmission.cable), plan.transmission.rules), {}, {}, {}, {}};

    const auto instants = simulate_instants(plan);
    for (const RegimeInstants& regime : plan.regimes) {
        for (const int sample : regime.samples) {
            study.scenarios.push_back(
                prepare_scenario(study.step, plan, regime.regime, sample, instants.at(sample)));
        }
    }
    for (Layout& layout : all_layouts(plan, study.nodes())) {
        const auto seen = std::find(study.sensor_sets.begin(), study.sensor_sets.end(), layout.nodes);
        const int index = static_cast<int>(seen - study.sensor_sets.begin());
        if (seen == study.sensor_sets.end()) study.sensor_sets.push_back(layout.nodes);
        study.layouts.push_back({std::move(layout), index});
    }
    for (const FusionMethod& method : fusion_methods()) {
        const auto& names = plan.fusion_methods;
        if (std::find(names.begin(), names.end(), method.name) != names.end())
            study.methods.push_back(&method);
    }
    return study;
}

std::map<std::string, double> no_sensor_errors_N(const StudyPlan& plan) {
    const PreparedStudy study = prepare(plan);
    std::map<Regime, double> sums_N;
    std::map<Regime, int> instants;
    for (const PreparedScenario& scenario : study.scenarios) {
        std::vector<double> certainty(static_cast<std::size_t>(scenario.curve.points()), 0.0);
        std::vector<double> mean_N(scenario.truth.tension_N.size());
        posterior_mean(scenario.curve, certainty, mean_N);
        for (std::size_t node = 0; node < mean_N.size(); ++node)
            sums_N[scenario.regime] +=
                std::abs(mean_N[node] - scenario.truth.tension_N[node]) / static_cast<double>(mean_N.size());
        ++instants[scenario.regime];
    }
    std::map<std::string, double> errors_N;
    for (const RegimeInstants& regime : plan.regimes) {
        const double error_N = sums_N[regime.regime] / instants[regime.regime];
        errors_N[std::string(name_of(regime.regime))] = error_N;
        errors_N["duty_cycle"] += regime.duty_fraction * error_N;
    }
    return errors_N;
}

}  // namespace capstan
