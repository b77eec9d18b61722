#include "random_bench.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "capstan/cable/cable_cut.h"

namespace capstan::fuzz {

namespace {

constexpr int spoilt_once_in = 64;

double any_radius_m(Choices& choices) {
    return choices.one_in(4) ? straight : choices.over_decades(1e-3, 10.0);
}

// Makes one field of the specification impossible; returns its name.
std::string spoil(CableSpecification& s, Choices& choices) {
    const double bad = choices.one_in(3) ? -1.0 : no_number(choices);
    switch (choices.below(8)) {
        case 0:
            s.curvature.front().length_m = bad;
            return "length_m";
        case 1:
            s.curvature.back().bend_radius_m = bad == straight ? 0.0 : bad;
            return "bend_radius_m";
        case 2:
            s.curvature.clear();
            return "no piece";
        case 3:
            s.segments = -choices.below(2);
            return "segments";
        case 4:
            s.axial_stiffness_N = bad;
            return "axial_stiffness_N";
        case 5:
            s.dynamic_friction = bad;
            return "dynamic_friction";
        case 6:
            s.static_friction = s.dynamic_friction == 0.0 ? -1.0 : 0.5 * s.dynamic_friction;
            return "static_friction";
        default:
            s.pretension_N = bad;
            return "pretension_N";
    }
}

double friction_exponent(const CableSpecification& s) {
    return s.static_friction * wrap_rad(s.curvature);
}

double any_displacement_m(Choices& choices, double now_m, double rest_m, double stretch_m) {
    switch (choices.below(16)) {
        case 0:
        case 1:
            return now_m;
        case 2:
        case 3:
            return rest_m;
        case 4:
            return choices.between(-0.3, 0.3);
        default:
            return now_m + (choices.one_in(2) ? 1.0 : -1.0) * stretch_m * choices.over_decades(1e-6, 3.0);
    }
}

double any_tension_N(Choices& choices, double now_N) {
    switch (choices.below(8)) {
        case 0:
            return now_N;
        case 1:
            return choices.one_in(2) ? 0.0 : -choices.over_decades(1e-3, 1e3);
        case 2:
            return choices.over_decades(1e-6, 1e4);
        default:
            return now_N * choices.between(0.5, 1.5);
    }
}

void spoil_end(EndCondition& end, Choices& choices) {
    double* const numbers[] = {&end.displacement_factor, &end.tension_factor, &end.value};
    *numbers[choices.below(3)] = choices.one_in(3) ? -1e300 : no_number(choices);
}

}  // namespace

double no_number(Choices& choices) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    switch (choices.below(3)) {
        case 0:
            return infinity;
        case 1:
            return -infinity;
        default:
            return std::numeric_limits<double>::quiet_NaN();
    }
}

Trial<CableSpecification> any_cable(Choices& choices) {
    CableSpecification s;
    const int pieces = 1 + choices.below(4);
    for (int k = 0; k < pieces; ++k) {
        s.curvature.push_back({choices.over_decades(1e-3, 3.0), any_radius_m(choices)});
    }
    s.segments = 1 + choices.below(60);
    s.axial_stiffness_N = choices.over_decades(10.0, 1e6);
    s.dynamic_friction = choices.one_in(8) ? 0.0 : choices.between(0.0, choices.one_in(2) ? 2.0 : 0.4);
    s.static_friction = s.dynamic_friction * (choices.one_in(2) ? 1.0 : choices.between(1.0, 3.0));
    s.pretension_N = choices.one_in(8) ? 0.0 : choices.over_decades(1e-3, 1e3);
    if (choices.one_in(spoilt_once_in)) {
        const std::string name = spoil(s, choices);
        return {s, name};
    }
    if (friction_exponent(s) > largest_friction_exponent) return {s, "static_friction times the wrap angle"};
    return {s};
}

ModelRules any_rules(Choices& choices) {
    return choices.one_in(3) ? ModelRules::paper() : ModelRules::consistent();
}

test::InputPair any_pair(Choices& choices) {
    const auto pairs = test::every_input_pair();
    return pairs[choices.below(static_cast<int>(pairs.size()))];
}

Trial<EndConditions> any_ends(Choices& choices, const test::InputPair& pair, const CableState& state,
                              const Cable& cable) {
    // By how much the cable is stretched, or would be by a newton: the scale of steps that mean something.
    const double stretch_m = std::max(std::abs(state.displacement_m.back() - state.displacement_m.front()),
                                      cable.length_m() / cable.axial_stiffness_N());
    const auto target = [&](const test::EndTarget& now, double end_rest_m) {
        return test::EndTarget{any_tension_N(choices, now.tension_N),
                               any_displacement_m(choices, now.displacement_m, end_rest_m, stretch_m)};
    };
    const CableState rest = pretensioned(cable);
    // A slack cable would mostly stay so.
    const bool back_to_rest = choices.one_in(state.last_motion.kind == MotionKind::slack ? 3 : 30);
    const CableState& from = back_to_rest ? rest : state;
    const test::EndTarget proximal = target(test::proximal_end(from), rest.displacement_m.front());
    const test::EndTarget distal = target(test::distal_end(from), rest.displacement_m.back());
    const double spring_N_per_m = choices.over_decades(1.0, 1e6);
    EndConditions ends = test::ends_of(pair, proximal, distal, spring_N_per_m);
    if (!choices.one_in(spoilt_once_in)) return {ends};

    switch (choices.below(6)) {
        case 0:
            spoil_end(ends.proximal, choices);
            return {ends, "proximal end's input is not a finite number"};
        case 1:
            spoil_end(ends.distal, choices);
            return {ends, "distal end's input is not a finite number"};
        case 2:
            ends = {EndCondition::tension_N(proximal.tension_N), EndCondition::tension_N(distal.tension_N)};
            return {ends, "a tension is prescribed at both ends"};
        case 3:
            ends.proximal = proximal_spring({-spring_N_per_m, proximal.tension_N, proximal.displacement_m});
            return {ends, "proximal end's input is a spring of negative stiffness"};
        case 4:
            ends = {EndCondition::position_m(-1e150), EndCondition::position_m(1e150)};
            return {ends, "a finite number below 1e150"};
        default:
            ends.distal = {0.0, 0.0, distal.tension_N};
            return {ends, "distal end's input says nothing"};
    }
}

}  // namespace capstan::fuzz
