#include "capstan/bench/bench_run.h"

#include "capstan/rig/bench_simulation.h"

namespace capstan::bench {

namespace {

using Each = std::function<void(const BenchInstant&)>;

BenchInstant instant_of(const PullPull& pair, const PullPullState& state, double time_s, bool solved) {
    return {time_s,
            pair.motor_torque_Nm(state),
            state.motor_angle_rad,
            pair.load_torque_Nm(state),
            state.load_angle_rad,
            solved,
            state.cable_a.tension_N,
            state.cable_b.tension_N};
}

void simulate_closed_form(const BenchPlan& plan, const PullPull& pair, const Each& each) {
    PullPullState state = pair.at_rest();
    PullPullState room = state;
    each(instant_of(pair, state, 0.0, true));
    for (int sample = 1; sample <= plan.samples(); ++sample) {
        const double time_s = sample / plan.sample_rate_Hz;
        const PullPullReport report = pair.advance(state, plan.inputs_at(time_s), room);
        each(instant_of(pair, state, time_s, report.solved()));
    }
}

// Tensions are those between the middles of the segments, and at the pulleys.
std::vector<double> node_tensions_N(const BenchSimulation& simulation, int cable, const Cable& description) {
    std::vector<double> tension_N = {simulation.motor_tension_N(cable)};
    for (int node = 1; node < description.segments(); ++node)
        tension_N.push_back(simulation.tension_at_N(cable, description.node_position_m(node)));
    tension_N.push_back(simulation.load_tension_N(cable));
    return tension_N;
}

void simulate_with_effects(const BenchPlan& plan, const Cable& cable, const Each& each) {
    BenchSimulation simulation({.cable = cable, .pulleys = plan.pulleys}, effects_with(plan.effects));
    const auto instant = [&](double time_s, bool solved) {
        return BenchInstant{time_s,
                            simulation.motor_torque_Nm(),
                            simulation.motor_angle_rad(),
                            simulation.load_torque_Nm(),
                            simulation.load_angle_rad(),
                            solved,
                            node_tensions_N(simulation, 0, cable),
                            node_tensions_N(simulation, 1, cable)};
    };
    each(instant(0.0, true));
    for (int sample = 1; sample <= plan.samples(); ++sample) {
        const double time_s = sample / plan.sample_rate_Hz;
        const PullPullInputs inputs = plan.inputs_at(time_s);
        const BenchReport report =
            simulation.advance({inputs.motor, inputs.load, 1.0 / plan.sample_rate_Hz, time_s});
        each(instant(time_s, report.converged));
    }
}

}  // namespace

void simulate_bench(const BenchPlan& plan, const Each& each) {
    const Cable cable(plan.cable);
    if (effects_there(plan.effects).empty()) {
        simulate_closed_form(plan, PullPull(cable, cable, plan.pulleys), each);
    } else {
        simulate_with_effects(plan, cable, each);
    }
}

}  // namespace capstan::bench
