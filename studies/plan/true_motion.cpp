#include "capstan/plan/true_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capstan/plan/true_cable.h"

namespace capstan {

namespace {

double sine(const EndMotion& end, double time_s) {
    return end.amplitude * std::sin(2.0 * std::numbers::pi * end.frequency_Hz * time_s + end.phase_rad);
}

// Relative to rest, so that sample 0 is the pretensioned cable for every phase.
double moved_since_start(const EndMotion& end, double time_s) {
    return sine(end, std::clamp(time_s, end.start_s, end.stop_s)) - sine(end, end.start_s);
}

}  // namespace

EndConditions ends_at(const Cable& cable, const TrueMotion& motion, int sample) {
    const double time_s = sample / motion.sample_rate_Hz;
    const double proximal_rest_m = -cable.pretension_N() * cable.length_m() / cable.axial_stiffness_N();
    const auto condition = [&](const EndMotion& end, double rest_m, auto spring) -> EndCondition {
        const double moved = moved_since_start(end, time_s);
        switch (end.kind) {
            case EndKind::position:
                return EndCondition::position_m(rest_m + moved);
            case EndKind::tension:
                return EndCondition::tension_N(cable.pretension_N() + moved);
            case EndKind::spring:
                return spring(WallSpring{end.spring_stiffness_N_per_m, cable.pretension_N(), rest_m + moved});
        }
        return {};
    };
    return {condition(motion.proximal, proximal_rest_m, proximal_spring),
            condition(motion.distal, 0.0, distal_spring)};
}

void simulate(const QuasiStaticStep& step, const TrueMotion& motion,
              const std::function<void(const TrueSample&)>& show) {
    CableState now = pretensioned(step.cable());
    CableState previous = now;
    for (int sample = 1; sample <= motion.samples; ++sample) {
        previous = now;
        const StepReport report = step.advance(now, ends_at(step.cable(), motion, sample));
        show({sample, previous, now, report});
    }
}

std::optional<Regime> regime_of(const MotionPattern& pattern) {
    switch (pattern.kind) {
        case MotionKind::mass:
            return Regime::mass;
        case MotionKind::opposed:
            return Regime::partial_both;
        case MotionKind::partial:
            if (pattern.distal_moving_nodes == 0) return Regime::partial_proximal;
            return pattern.proximal_moving_nodes == 0 ? Regime::partial_distal : Regime::partial_both;
        case MotionKind::rest:
        case MotionKind::slack:
            return std::nullopt;
    }
    return std::nullopt;
}

CableSpecification true_specification(CableSpecification model, const TrueCable& truth) {
    model.dynamic_friction *= truth.friction_ratio;
    model.static_friction *= truth.friction_ratio;
    model.axial_stiffness_N *= truth.stiffness_ratio;
    model.pretension_N *= truth.pretension_ratio;
    return model;
}

}  // namespace capstan
