#include <algorithm>
#include <cmath>

#include "capstan/cable/cable_cut.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/plan/true_motion.h"
#include "capstan/rig/bench_simulation.h"

namespace capstan {

namespace {

// Simulation segments when effects are simulated, at least.
constexpr int min_segments = 60;
// A node that moves less than this fraction of the largest motion is at rest: bristles give a little.
constexpr double at_rest_fraction = 1e-2;
// Displacements are turns of this pulley.
constexpr double radius_m = 1.0;

// The same cable in equal segments, which is what a bench takes.
Cable simulated_cable(CableSpecification specification) {
    specification.node_places_m.clear();
    specification.segments *= (min_segments + specification.segments - 1) / specification.segments;
    return Cable(specification);
}

double displacement_at_m(const BenchSimulation& bench, const Cable& simulated, double position_m) {
    const int node = simulated.nearest_node(position_m);
    if (std::abs(simulated.node_position_m(node) - position_m) <= same_place_m)
        return bench.displacement_m(0, node);
    const auto [segment, fraction] = simulated.spot_at(position_m);
    return (1.0 - fraction) * bench.displacement_m(0, segment) +
           fraction * bench.displacement_m(0, segment + 1);
}

CableState read_off(const BenchSimulation& bench, const Cable& simulated, const Cable& cable) {
    CableState state;
    for (int node = 0; node < cable.nodes(); ++node) {
        const double position_m = cable.node_position_m(node);
        state.displacement_m.push_back(displacement_at_m(bench, simulated, position_m));
        state.tension_N.push_back(bench.tension_at_N(0, position_m));
    }
    state.tension_N.front() = bench.motor_tension_N(0);
    state.tension_N.back() = bench.load_tension_N(0);
    return state;
}

// The moving nodes from both ends up to the first node that rests or moves the other way.
MotionPattern pattern_between(const CableState& before, const CableState& now) {
    const int nodes = static_cast<int>(now.displacement_m.size());
    std::vector<double> moved;
    double most = 0.0;
    for (std::size_t node = 0; node < now.displacement_m.size(); ++node) {
        moved.push_back(now.displacement_m[node] - before.displacement_m[node]);
        most = std::max(most, std::abs(moved.back()));
    }
    const auto way = [&](int node) {
        const double by = moved[static_cast<std::size_t>(node)];
        return std::abs(by) <= at_rest_fraction * most ? Direction::none : direction_of(by);
    };
    const auto moving_from = [&](int end, int step) {
        int count = 0;
        for (int node = end; count < nodes && way(node) == way(end) && way(end) != Direction::none;
             node += step)
            ++count;
        return count;
    };
    MotionPattern pattern;
    pattern.proximal_moving_nodes = moving_from(0, 1);
    pattern.distal_moving_nodes = moving_from(nodes - 1, -1);
    if (pattern.proximal_moving_nodes > 0) pattern.proximal_direction = way(0);
    if (pattern.distal_moving_nodes > 0) pattern.distal_direction = way(nodes - 1);
    const int moving = pattern.proximal_moving_nodes + pattern.distal_moving_nodes;
    // A held end belongs to a cable that slides along its entire length.
    const bool all_but_an_end =
        pattern.proximal_moving_nodes == nodes - 1 && pattern.distal_moving_nodes == 0;
    const bool all_but_the_first =
        pattern.distal_moving_nodes == nodes - 1 && pattern.proximal_moving_nodes == 0;
    if (moving == 0) {
        pattern.kind = MotionKind::rest;
    } else if (moving == 2 * nodes || all_but_an_end || all_but_the_first) {
        const Direction direction =
            pattern.proximal_moving_nodes > 0 ? pattern.proximal_direction : pattern.distal_direction;
        pattern = {MotionKind::mass, direction, direction, nodes, nodes};
    } else if (moving >= nodes) {
        pattern.kind = MotionKind::opposed;
        pattern.distal_moving_nodes = nodes - pattern.proximal_moving_nodes;
        pattern.zero_velocity_fraction = 0.5;
    } else {
        pattern.kind = MotionKind::partial;
    }
    return pattern;
}

void simulate_effects(const StudyPlan& plan, const ShowStates& show) {
    const CableSpecification specification = true_specification(plan.transmission.cable, plan.truth);
    const Cable cable(specification);
    CableWithEffects with_effects(specification, plan.truth.effects, plan.motion.sample_rate_Hz);
    CableState now = with_effects.state();
    CableState previous = now;
    const EndConditions rest = ends_at(cable, plan.motion, 0);
    for (int sample = 1; sample <= plan.motion.samples; ++sample) {
        previous = now;
        const EndConditions ends = ends_at(cable, plan.motion, sample);
        if (!with_effects.advance(sample, ends.proximal.value - rest.proximal.value,
                                  ends.distal.value - rest.distal.value))
            throw InvalidInput({"truth: the motion with these effects has no solution at sample " +
                                std::to_string(sample) + "; make the effects smaller"});
        now = with_effects.state();
        now.last_motion = pattern_between(previous, now);
        show(sample, previous, now);
    }
}

}  // namespace

std::vector<KeyProblem> problems_of_truth(const StudyPlan& plan) {
    std::vector<KeyProblem> problems;
    for (const double ratio :
         {plan.truth.friction_ratio, plan.truth.stiffness_ratio, plan.truth.pretension_ratio}) {
        if (!(ratio > 0.0)) problems.push_back({"truth", "a ratio must be above 0"});
    }
    for (std::size_t e = 0; e < effect_catalogue().size(); ++e) {
        const std::size_t given = plan.truth.effect_deviations[e].size();
        const Effect& effect = effect_catalogue()[e];
        if (given != 0 && given != effect.parameters.size())
            problems.push_back({"truth", "deviations of " + effect.name + " are " + std::to_string(given) +
                                             " numbers, but the effect has " +
                                             std::to_string(effect.parameters.size())});
    }
    if (!plan.truth.has_effects()) return problems;
    for (const EndMotion* end : {&plan.motion.proximal, &plan.motion.distal}) {
        if (end->kind != EndKind::position)
            problems.push_back({"truth",
                                "effects are simulated between ends whose positions are given; make both "
                                "motion.proximal.kind and motion.distal.kind \"position\""});
    }
    return problems;
}

void simulate_truth(const StudyPlan& plan, const ShowStates& show) {
    if (const auto problems = problems_of_truth(plan); !problems.empty()) throw InvalidInput(problems);
    if (plan.truth.has_effects()) return simulate_effects(plan, show);
    const QuasiStaticStep step(Cable(true_specification(plan.transmission.cable, plan.truth)),
                               plan.transmission.rules);
    simulate(step, plan.motion,
             [&](const TrueSample& sample) { show(sample.sample, sample.previous, sample.now); });
}

struct CableWithEffects::Bench {
    Cable simulated;
    double sample_rate_Hz;
    BenchSimulation simulation;

    Bench(const CableSpecification& cable, const EffectValues& effects, double rate_Hz)
        : simulated(simulated_cable(cable)),
          sample_rate_Hz(rate_Hz),
          simulation(
              {.cable = simulated, .arrangement = CableArrangement::single, .pulleys = {radius_m, radius_m}},
              effects_with(effects)) {}
};

CableWithEffects::CableWithEffects(const CableSpecification& cable, const EffectValues& effects,
                                   double sample_rate_Hz)
    : cable_(cable),
      bench_(std::make_unique<Bench>(cable, effects, sample_rate_Hz)),
      now_(read_off(bench_->simulation, bench_->simulated, cable_)) {}

CableWithEffects::~CableWithEffects() = default;

bool CableWithEffects::advance(int sample, double proximal_m, double distal_m) {
    // The motor pulley reels in when its end moves backward.
    const BenchInputs inputs{MotorAngle{-proximal_m / radius_m}, LoadAngle{-distal_m / radius_m},
                             1.0 / bench_->sample_rate_Hz, sample / bench_->sample_rate_Hz};
    if (!bench_->simulation.advance(inputs).converged) return false;
    now_ = read_off(bench_->simulation, bench_->simulated, cable_);
    return true;
}

}  // namespace capstan
