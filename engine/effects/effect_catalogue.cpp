#include "capstan/effects/effect_catalogue.h"

namespace capstan {

namespace {

using Values = std::span<const double>;

std::vector<Effect> friction_laws() {
    return {
        {"viscous_friction",
         "",
         "friction law",
         "conduit",
         "",
         "E20",
         "drag that grows with sliding speed, as of a lubricant",
         {{"drag", "N s/m2", 0.0, 1e4, 1.0}},
         {0.0},
         [](BenchEffects& effects, Values p) { effects.viscous_friction.drag_N_s_per_m2 = p[0]; }},
        {"stribeck",
         "",
         "friction law",
         "conduit",
         "",
         "E21",
         "friction that is higher at low speed, with a lag",
         {{"extra_friction", "", 0.0, 2.0, 0.05},
          {"speed", "m/s", 1e-4, 10.0, 0.05},
          {"memory", "s", 0.0, 1.0, 0.04}},
         {0.0, 0.05, 0.04},
         [](BenchEffects& effects, Values p) {
             effects.stribeck = {p[0], p[1], p[2]};
         }},
        {"presliding",
         "",
         "friction law",
         "conduit",
         "",
         "E22",
         "friction that builds up over a small displacement",
         {{"length", "m", 0.0, 0.1, 5e-4}},
         {0.0},
         [](BenchEffects& effects, Values p) {
             effects.presliding = {p[0], 1.0};
         }},
        {"load_dependent_friction",
         "",
         "friction law",
         "conduit",
         "",
         "E23",
         "a friction coefficient that changes with the normal force",
         {{"exponent", "", 0.2, 2.0, 0.8}, {"reference", "N/m", 1e-3, 1e4, 10.0}},
         {1.0, 10.0},
         [](BenchEffects& effects, Values p) {
             effects.load_dependent_friction = {p[0], p[1]};
         }},
        {"bending_stiffness",
         "",
         "friction law",
         "conduit",
         "",
         "E24",
         "constant drag per length, whatever the tension",
         {{"drag", "N/m", 0.0, 100.0, 0.2}},
         {0.0},
         [](BenchEffects& effects, Values p) { effects.bending_stiffness.drag_N_per_m = p[0]; }},
    };
}

Effect local_bend(BentCables cables, const std::string& variant) {
    return {"local_bend",
            variant,
            "friction place",
            "conduit",
            "",
            "E25",
            "a tight bend that the routing does not show",
            {{"angle", "rad", 0.0, 20.0, 0.5},
             {"middle", "m", 0.0, 100.0, 1.0},
             {"length", "m", 1e-3, 10.0, 0.15}},
            {0.0, 1.0, 0.15},
            [cables](BenchEffects& effects, Values p) {
                effects.local_bend = {{p[1] - 0.5 * p[2], p[1] + 0.5 * p[2]}, p[0], cables};
            }};
}

std::vector<Effect> friction_places() {
    return {
        local_bend(BentCables::both, "both cables"),
        local_bend(BentCables::only_a, "cable A"),
        local_bend(BentCables::only_b, "cable B"),
        {"moving_bend",
         "",
         "friction place",
         "conduit",
         "",
         "E26",
         "wrap angle that follows the load angle",
         {{"angle_per_load_angle", "", -20.0, 20.0, 1.0},
          {"middle", "m", 0.0, 100.0, 1.0},
          {"length", "m", 1e-3, 10.0, 0.3}},
         {0.0, 1.0, 0.3},
         [](BenchEffects& effects, Values p) {
             effects.moving_bend = {{p[1] - 0.5 * p[2], p[1] + 0.5 * p[2]}, p[0]};
         }},
    };
}

std::vector<Effect> load_pulley_friction() {
    Effect fades = {"pulley_friction",
                    "load",
                    "end friction",
                    "load_pulley",
                    "load",
                    "E27",
                    "friction of the load pulley's bearing, which fades at rest",
                    {{"coulomb", "N m", 0.0, 10.0, 0.05}, {"viscous", "N m s", 0.0, 10.0, 1e-2}},
                    {0.0, 0.0},
                    [](BenchEffects& effects, Values p) {
                        effects.load_friction = {p[0], p[1]};
                    }};
    Effect holds = fades;
    holds.variant = "load holding";
    holds.meaning = "friction of the load pulley's bearing, which holds at rest";
    holds.parameters.push_back({"presliding", "rad", 1e-5, 0.1, 2e-4});
    holds.absent.push_back(2e-4);
    holds.apply = [](BenchEffects& effects, Values p) { effects.load_friction = {p[0], p[1], p[2]}; };
    return {fades, holds};
}

std::vector<Effect> ends() {
    return {
        {"pulley_friction",
         "motor",
         "end friction",
         "motor",
         "motor",
         "E27",
         "friction of the motor pulley's bearing",
         {{"coulomb", "N m", 0.0, 10.0, 0.01}, {"viscous", "N m s", 0.0, 10.0, 1e-3}},
         {0.0, 0.0},
         [](BenchEffects& effects, Values p) {
             effects.motor_friction = {p[0], p[1]};
         }},
        load_pulley_friction()[0],
        load_pulley_friction()[1],
        {"motor_cogging",
         "",
         "actuator",
         "motor",
         "motor",
         "E28",
         "torque ripple, periodic in the motor angle",
         {{"sine", "N m", -10.0, 10.0, 0.005},
          {"cosine", "N m", -10.0, 10.0, 0.005},
          {"periods_per_turn", "", 1.0, 200.0, 7.0}},
         {0.0, 0.0, 7.0},
         [](BenchEffects& effects, Values p) {
             effects.motor_cogging = {p[0], p[1], p[2]};
         }},
        {"inertia",
         "motor",
         "actuator",
         "motor",
         "motor",
         "E35",
         "inertia of rotor and motor pulley",
         {{"inertia", "kg m2", 0.0, 10.0, 1e-4}},
         {0.0},
         [](BenchEffects& effects, Values p) { effects.inertia.motor_kg_m2 = p[0]; }},
        {"inertia",
         "load",
         "actuator",
         "load_pulley",
         "load",
         "E35",
         "inertia of load pulley and handle",
         {{"inertia", "kg m2", 0.0, 10.0, 2e-3}},
         {0.0},
         [](BenchEffects& effects, Values p) { effects.inertia.load_kg_m2 = p[0]; }},
        {"backlash",
         "motor",
         "lost motion",
         "motor",
         "motor",
         "E29",
         "lost motion between motor and motor pulley",
         {{"half_gap", "rad", 0.0, 1.0, 0.01}},
         {0.0},
         [](BenchEffects& effects, Values p) { effects.motor_backlash.half_gap_rad = p[0]; }},
        {"backlash",
         "load",
         "lost motion",
         "load_pulley",
         "load",
         "E29",
         "lost motion between load pulley and handle",
         {{"half_gap", "rad", 0.0, 1.0, 0.005}},
         {0.0},
         [](BenchEffects& effects, Values p) { effects.load_backlash.half_gap_rad = p[0]; }},
    };
}

std::vector<Effect> compliances() {
    return {
        {"conduit_compliance",
         "motor",
         "compliance",
         "conduit",
         "motor",
         "E30",
         "a sheath end or mount that gives at the motor",
         {{"compliance", "m/N", 0.0, 0.1, 1e-4}},
         {0.0},
         [](BenchEffects& effects, Values p) { effects.conduit_compliance.motor_m_per_N = p[0]; }},
        {"conduit_compliance",
         "load",
         "compliance",
         "conduit",
         "load",
         "E30",
         "a sheath end or mount that gives at the load",
         {{"compliance", "m/N", 0.0, 0.1, 1e-4}},
         {0.0},
         [](BenchEffects& effects, Values p) { effects.conduit_compliance.load_m_per_N = p[0]; }},
        {"cable_stiffness_nonlinear",
         "",
         "compliance",
         "cable",
         "",
         "E31",
         "a cable that is soft at low tension and stiffens",
         {{"toe_strain", "", 0.0, 0.1, 1e-3}, {"toe_tension", "N", 0.1, 1e4, 10.0}},
         {0.0, 10.0},
         [](BenchEffects& effects, Values p) {
             effects.nonlinear_stiffness = {p[0], p[1]};
         }},
        {"creep",
         "",
         "compliance",
         "cable",
         "",
         "E32",
         "strain that follows tension over seconds",
         {{"ratio", "", 0.0, 10.0, 0.2}, {"time_constant", "s", 0.05, 100.0, 2.0}},
         {0.0, 2.0},
         [](BenchEffects& effects, Values p) {
             effects.creep = {p[0], p[1]};
         }},
        {"environment_coupling",
         "",
         "compliance",
         "environment",
         "load",
         "E34",
         "a spring and a damper between load pulley and hand",
         {{"compliance", "rad/(N m)", 0.0, 1.0, 0.01}, {"damping", "N m s/rad", 0.0, 1e3, 0.1}},
         {0.0, 0.0},
         [](BenchEffects& effects, Values p) {
             effects.environment_coupling = {p[0], p[1]};
         }},
        {"pretension_drift",
         "",
         "pretension",
         "cable",
         "",
         "E33",
         "pretension that falls over the session",
         {{"lost_by_100_s", "", -1.0, 1.0, 0.1}},
         {0.0},
         [](BenchEffects& effects, Values p) { effects.pretension_drift.lost_by_100_s = p[0]; }},
    };
}

}  // namespace

const std::vector<Effect>& effect_catalogue() {
    static const std::vector<Effect> all = [] {
        std::vector<Effect> effects;
        for (const auto& family : {friction_laws(), friction_places(), ends(), compliances()})
            effects.insert(effects.end(), family.begin(), family.end());
        return effects;
    }();
    return all;
}

EffectValues absent_effects() {
    EffectValues absent;
    for (const Effect& effect : effect_catalogue()) absent.push_back(effect.absent);
    return absent;
}

BenchEffects effects_with(const EffectValues& values) {
    BenchEffects effects;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Effect& effect = effect_catalogue()[k];
        if (values[k] != effect.absent) effect.apply(effects, values[k]);
    }
    return effects;
}

std::vector<std::string> effects_there(const EffectValues& values) {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Effect& effect = effect_catalogue()[k];
        if (values[k] == effect.absent) continue;
        names.push_back(effect.variant.empty() ? effect.name : effect.name + " (" + effect.variant + ")");
    }
    return names;
}

}  // namespace capstan
