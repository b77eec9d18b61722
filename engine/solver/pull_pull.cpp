#include "capstan/solver/pull_pull.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "capstan/cable/invalid_input.h"

namespace capstan {

namespace {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>  // clang 14 does not deduce it of itself
Overloaded(Functions...)->Overloaded<Functions...>;

// A search inside another must leave no error that the outer one could see.
constexpr double inner_tolerance_Nm = 0.01 * torque_tolerance_Nm;

void demand_solvable(const PullPullInputs& inputs) {
    std::vector<std::string> problems;
    const auto demand_finite = [&](double value, const char* what) {
        if (!std::isfinite(value)) problems.push_back(std::string("the ") + what + " is not a finite number");
    };
    std::visit(Overloaded{[&](const MotorAngle& m) { demand_finite(m.angle_rad, "motor angle"); },
                          [&](const MotorTorque& m) { demand_finite(m.torque_Nm, "motor torque"); }},
               inputs.motor);
    std::visit(Overloaded{[&](const LoadAngle& l) { demand_finite(l.angle_rad, "load angle"); },
                          [&](const LoadTorque& l) { demand_finite(l.torque_Nm, "load torque"); },
                          [&](const LoadSpring& l) {
                              demand_finite(l.stiffness_Nm_per_rad, "load spring's stiffness");
                              demand_finite(l.wall_angle_rad, "wall angle");
                              if (l.stiffness_Nm_per_rad <= 0.0)
                                  problems.push_back(
                                      "the load spring's stiffness is not positive, so the load is not held; "
                                      "for a free load prescribe a load torque of 0 and a motor angle");
                          }},
               inputs.load);
    if (std::holds_alternative<MotorTorque>(inputs.motor) &&
        std::holds_alternative<LoadTorque>(inputs.load)) {
        problems.push_back(
            "a torque is prescribed at both pulleys, so the angles are undetermined; prescribe an angle or a "
            "spring at one of them");
    }
    if (!problems.empty()) throw InvalidInput(problems);
}

}  // namespace

Pulleys checked(const Pulleys& pulleys) {
    std::vector<std::string> problems;
    const auto check = [&](double radius_m, const std::string& name) {
        if (!(radius_m > 0.0) || !std::isfinite(radius_m)) {
            problems.push_back("the " + name +
                               " pulley's radius is not a positive length; give it in metres");
        }
    };
    check(pulleys.motor_radius_m, "motor");
    check(pulleys.load_radius_m, "load");
    if (!problems.empty()) throw InvalidInput(problems);
    return pulleys;
}

// One guess of the angles, always made from the state before the step.
struct PullPull::Trial {
    const PullPullState& before;
    PullPullState& after;
    PullPullReport report;
};

PullPull::PullPull(const Cable& cable_a, const Cable& cable_b, const Pulleys& pulleys,
                   const ModelRules& rules)
    : step_a_(cable_a, rules),
      step_b_(cable_b, rules),
      pulleys_(checked(pulleys)),
      rest_a_m_(pretensioned(cable_a).displacement_m.front()),
      rest_b_m_(pretensioned(cable_b).displacement_m.front()) {}

PullPullState PullPull::at_rest() const {
    return {pretensioned(cable_a()), pretensioned(cable_b()), 0.0, 0.0};
}

double PullPull::motor_torque_Nm(const PullPullState& state) const {
    return pulleys_.motor_radius_m *
           (state.cable_a.tension_N.front() - state.cable_b.tension_N.front());  // E16
}

double PullPull::load_torque_Nm(const PullPullState& state) const {
    return pulleys_.load_radius_m * (state.cable_a.tension_N.back() - state.cable_b.tension_N.back());  // E16
}

PullPullReport PullPull::advance(PullPullState& state, const PullPullInputs& inputs) const {
    PullPullState workspace = state;
    return advance(state, inputs, workspace);
}

PullPullReport PullPull::advance(PullPullState& state, const PullPullInputs& inputs,
                                 PullPullState& workspace) const {
    demand_solvable(inputs);
    Trial trial{state, workspace, {}};
    std::visit(Overloaded{[&](const MotorAngle& motor) {
                              load_settles(trial, motor.angle_rad, inputs.load, torque_tolerance_Nm);
                          },
                          [&](const MotorTorque& motor) {
                              const double steepest =
                                  pulleys_.motor_radius_m * pulleys_.motor_radius_m * end_stiffness_N_per_m();
                              trial.report.motor = search_angle(
                                  {state.motor_angle_rad, steepest}, [&](double motor_angle_rad) {
                                      load_settles(trial, motor_angle_rad, inputs.load, inner_tolerance_Nm);
                                      return motor_torque_Nm(trial.after) - motor.torque_Nm;
                                  });
                          }},
               inputs.motor);
    std::swap(state, workspace);
    return trial.report;
}

// Both cables with both angles known (E15).
void PullPull::turn_to(Trial& trial, double motor_angle_rad, double load_angle_rad) const {
    const double reeled_in_m = pulleys_.motor_radius_m * motor_angle_rad;
    const double given_m = pulleys_.load_radius_m * load_angle_rad;
    trial.after.cable_a = trial.before.cable_a;
    trial.after.cable_b = trial.before.cable_b;
    trial.report.cable_a = step_a_.advance(
        trial.after.cable_a,
        {EndCondition::position_m(rest_a_m_ - reeled_in_m), EndCondition::position_m(-given_m)});
    trial.report.cable_b = step_b_.advance(
        trial.after.cable_b,
        {EndCondition::position_m(rest_b_m_ + reeled_in_m), EndCondition::position_m(given_m)});
    trial.after.motor_angle_rad = motor_angle_rad;
    trial.after.load_angle_rad = load_angle_rad;
}

// The motor angle is known; the load goes where its input allows (E17).
void PullPull::load_settles(Trial& trial, double motor_angle_rad, const LoadInput& load,
                            double stop_at_Nm) const {
    // A load that turns with cable A slackens A and tightens B: the torque on it falls.
    const double steepest = -pulleys_.load_radius_m * pulleys_.load_radius_m * end_stiffness_N_per_m();
    const double start_rad = trial.before.load_angle_rad;
    std::visit(Overloaded{[&](const LoadAngle& angle) { turn_to(trial, motor_angle_rad, angle.angle_rad); },
                          [&](const LoadTorque& torque) {
                              trial.report.load =
                                  search_angle({start_rad, steepest, stop_at_Nm}, [&](double load_angle_rad) {
                                      turn_to(trial, motor_angle_rad, load_angle_rad);
                                      return load_torque_Nm(trial.after) - torque.torque_Nm;
                                  });
                          },
                          [&](const LoadSpring& spring) {
                              trial.report.load = search_angle(
                                  {start_rad, steepest - spring.stiffness_Nm_per_rad, stop_at_Nm},
                                  [&](double load_angle_rad) {
                                      turn_to(trial, motor_angle_rad, load_angle_rad);
                                      return load_torque_Nm(trial.after) -
                                             spring.stiffness_Nm_per_rad *
                                                 (load_angle_rad - spring.wall_angle_rad);
                                  });
                          }},
               load);
}

// Both cables' ends when each moves its last node alone: no longer run is stiffer.
double PullPull::end_stiffness_N_per_m() const {
    const auto stiffer_end = [](const Cable& cable) {
        return 2.0 / std::min(cable.segment_compliance_m_per_N(0),
                              cable.segment_compliance_m_per_N(cable.segments() - 1));
    };
    return stiffer_end(cable_a()) + stiffer_end(cable_b());
}

}  // namespace capstan
