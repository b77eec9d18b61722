#include "capstan/sensitivity/uncertain_parameter.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "capstan/cable/cable_cut.h"

namespace capstan::sensitivity {

namespace {

double wrap_angle_rad(const StudyPlan& plan, int) {
    return wrap_rad(plan.transmission.cable.curvature);
}

double noise_at_pretension_N(const StudyPlan& plan, int noise_index) {
    for (const SensorRow& sensor : plan.sensors) {
        if (!measures_tension(sensor.kind)) continue;
        return std::hypot(sensor.errors.multiplicative_ratio * plan.transmission.cable.pretension_N,
                          sensor.errors.additive);
    }
    if (plan.noise_levels.empty()) return 0.0;
    return reading_deviation_N(plan.noise_levels[noise_index].level, plan.transmission.cable.pretension_N);
}

void scale_friction(StudyPlan& plan, int, double ratio) {
    plan.transmission.cable.dynamic_friction *= ratio;
    plan.transmission.cable.static_friction *= ratio;
}

void scale_curvature(StudyPlan& plan, int, double ratio) {
    for (auto& piece : plan.transmission.cable.curvature) piece.bend_radius_m /= ratio;
}

void scale_noise(StudyPlan& plan, int noise_index, double ratio) {
    for (SensorRow& sensor : plan.sensors)
        for (double* error : {&sensor.errors.multiplicative_ratio, &sensor.errors.additive,
                              &sensor.errors.zero, &sensor.errors.gain_ratio})
            *error *= ratio;
    if (plan.noise_levels.empty()) return;
    NoiseLevel& level = plan.noise_levels[noise_index].level;
    level.multiplicative_ratio *= ratio;
    level.additive_N *= ratio;
    level.bias_N *= ratio;
}

int nearest(const std::vector<int>& samples, int sample) {
    return *std::min_element(samples.begin(), samples.end(),
                             [sample](int a, int b) { return std::abs(a - sample) < std::abs(b - sample); });
}

bool move_instants(StudyPlan& plan) {
    const auto samples = samples_by_regime(plan);
    std::vector<RegimeInstants> left;
    double fraction = 0.0;
    for (RegimeInstants regime : plan.regimes) {
        const auto found = samples.find(regime.regime);
        if (found == samples.end()) continue;
        for (int& sample : regime.samples) sample = nearest(found->second, sample);
        fraction += regime.duty_fraction;
        left.push_back(std::move(regime));
    }
    if (left.empty()) return false;
    const bool all_left = left.size() == plan.regimes.size();
    for (RegimeInstants& regime : left) {
        if (!all_left)
            regime.duty_fraction = fraction > 0.0 ? regime.duty_fraction / fraction : 1.0 / left.size();
    }
    plan.regimes = std::move(left);
    return true;
}

}  // namespace

const std::vector<UncertainParameter>& uncertain_parameters() {
    static const std::vector<UncertainParameter> all = {
        {"friction", "friction coefficient", "",
         [](const SensitivityPlan& plan) { return plan.friction_ratio; },
         [](const StudyPlan& plan, int) { return plan.transmission.cable.dynamic_friction; }, scale_friction},
        {"curvature", "wrap angle", "rad", [](const SensitivityPlan& plan) { return plan.curvature_ratio; },
         wrap_angle_rad, scale_curvature},
        {"stiffness", "axial stiffness", "N",
         [](const SensitivityPlan& plan) { return plan.stiffness_ratio; },
         [](const StudyPlan& plan, int) { return plan.transmission.cable.axial_stiffness_N; },
         [](StudyPlan& plan, int, double ratio) { plan.transmission.cable.axial_stiffness_N *= ratio; }},
        {"pretension", "pretension", "N", [](const SensitivityPlan& plan) { return plan.pretension_ratio; },
         [](const StudyPlan& plan, int) { return plan.transmission.cable.pretension_N; },
         [](StudyPlan& plan, int, double ratio) { plan.transmission.cable.pretension_N *= ratio; }},
        {"noise", "noise at the pretension", "N",
         [](const SensitivityPlan& plan) { return plan.noise_ratio; }, noise_at_pretension_N, scale_noise},
    };
    return all;
}

std::optional<StudyPlan> plan_with(const StudyPlan& plan, int noise_index, const std::vector<double>& ratio) {
    StudyPlan scaled = plan;
    for (std::size_t p = 0; p < ratio.size(); ++p) {
        if (ratio[p] != 1.0) uncertain_parameters()[p].scale(scaled, noise_index, ratio[p]);
    }
    if (!move_instants(scaled)) return std::nullopt;
    return scaled;
}

}  // namespace capstan::sensitivity
