#include "pull_pull_walk.h"

#include <ostream>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/pull_pull.h"
#include "promises.h"
#include "random_bench.h"

namespace capstan::fuzz {

namespace {

double any_angle_rad(Choices& choices, double now_rad) {
    if (choices.one_in(8)) return now_rad;
    return now_rad + (choices.one_in(2) ? 1.0 : -1.0) * choices.over_decades(1e-8, 1.0);
}

double any_torque_Nm(Choices& choices, double now_Nm) {
    if (choices.one_in(8)) return 0.0;
    return choices.one_in(4) ? choices.between(-2.0, 2.0) : now_Nm * choices.between(0.5, 1.5);
}

MotorInput any_motor(Choices& choices, const PullPull& pair, const PullPullState& state) {
    if (choices.one_in(3)) return MotorTorque{any_torque_Nm(choices, pair.motor_torque_Nm(state))};
    return MotorAngle{any_angle_rad(choices, state.motor_angle_rad)};
}

LoadInput any_load(Choices& choices, const PullPull& pair, const PullPullState& state) {
    switch (choices.below(4)) {
        case 0:
            return LoadTorque{any_torque_Nm(choices, pair.load_torque_Nm(state))};
        case 1:
            return LoadSpring{choices.over_decades(1e-3, 1e3), any_angle_rad(choices, state.load_angle_rad)};
        default:
            return LoadAngle{any_angle_rad(choices, state.load_angle_rad)};
    }
}

Trial<PullPullInputs> any_inputs(Choices& choices, const PullPull& pair, const PullPullState& state) {
    PullPullInputs inputs{any_motor(choices, pair, state), any_load(choices, pair, state)};
    const bool spoilt = choices.one_in(64);
    if (spoilt && choices.one_in(2)) return {{MotorTorque{no_number(choices)}, inputs.load}, "motor torque"};
    if (spoilt) return {{inputs.motor, LoadSpring{-1.0, 0.0}}, "stiffness is not positive"};
    if (std::holds_alternative<MotorTorque>(inputs.motor) &&
        std::holds_alternative<LoadTorque>(inputs.load)) {
        return {inputs, "a torque is prescribed at both pulleys"};
    }
    return {inputs};
}

void write(std::ostream& out, const PullPullInputs& inputs) {
    if (const auto* angle = std::get_if<MotorAngle>(&inputs.motor))
        out << "  motor angle " << angle->angle_rad;
    if (const auto* torque = std::get_if<MotorTorque>(&inputs.motor))
        out << "  motor torque " << torque->torque_Nm;
    if (const auto* angle = std::get_if<LoadAngle>(&inputs.load)) out << ", load angle " << angle->angle_rad;
    if (const auto* torque = std::get_if<LoadTorque>(&inputs.load))
        out << ", load torque " << torque->torque_Nm;
    if (const auto* spring = std::get_if<LoadSpring>(&inputs.load)) {
        out << ", load spring " << spring->stiffness_Nm_per_rad << " to a wall at " << spring->wall_angle_rad;
    }
    out << "\n";
}

}  // namespace

void pull_pull_walk(const Cable& cable, Choices& choices, Tally& tally, std::ostream* trace) {
    Trial<CableSpecification> other = any_cable(choices);
    while (!other.refused_by.empty() && !choices.used_up()) other = any_cable(choices);
    if (!other.refused_by.empty()) return;
    const Cable cable_b(other.input);
    const PullPull pair(cable, cable_b, {choices.over_decades(1e-3, 0.2), choices.over_decades(1e-3, 0.2)},
                        any_rules(choices));
    PullPullState state = pair.at_rest();
    while (!choices.used_up()) {
        const Trial<PullPullInputs> trial = any_inputs(choices, pair, state);
        if (trace) write(*trace, trial.input);
        const PullPullState before = state;
        ++tally.pull_pull_steps;
        try {
            const PullPullReport report = pair.advance(state, trial.input);
            if (!trial.refused_by.empty()) throw BrokenPromise("taken, not refused: " + trial.refused_by);
            demand_a_state(cable, state.cable_a);
            demand_a_state(cable_b, state.cable_b);
            tally.unmet_torques += !report.motor.converged || !report.load.converged;
        } catch (const InvalidInput& refusal) {
            if (trial.refused_by.empty()) throw BrokenPromise(std::string("refused: ") + refusal.what());
            demand_words(refusal.what(), trial.refused_by);
            demand_unchanged(before.cable_a, state.cable_a);
            demand_unchanged(before.cable_b, state.cable_b);
            ++tally.refused[trial.refused_by];
        }
    }
}

}  // namespace capstan::fuzz
