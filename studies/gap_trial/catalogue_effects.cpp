#include <algorithm>
#include <cmath>

#include "capstan/gap_trial/withheld_effect.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap_trial {

namespace {

WithheldEffect sized(const std::string& effect, const std::string& component, const std::string& size_name,
                     double first_size, double largest_size,
                     std::function<void(TrueEffects&, double)> apply) {
    WithheldEffect withheld;
    withheld.effect = withheld.kind = effect;
    withheld.component = component;
    withheld.size_name = size_name;
    withheld.first_size = first_size;
    withheld.largest_size = largest_size;
    withheld.apply = std::move(apply);
    return withheld;
}

WithheldEffect at_end(WithheldEffect effect, const std::string& end) {
    effect.end = end;
    effect.kind += "_" + end;
    return effect;
}

WithheldEffect viscous_friction(const EffectSetting&, TrialStream&) {
    return sized("viscous_friction", "conduit", "drag_N_s_per_m2", 1.0, 40.0,
                 [](TrueEffects& e, double size) { e.viscous_drag_N_s_per_m2 = size; });
}

WithheldEffect stribeck(const EffectSetting&, TrialStream& draws) {
    const TrueStribeck shape{0.0, draws.log_uniform(0.02, 0.08), draws.uniform(0.02, 0.06)};
    WithheldEffect effect =
        sized("stribeck", "conduit", "extra_friction", 0.04, 0.4, [shape](TrueEffects& e, double size) {
            e.stribeck = shape;
            e.stribeck.extra_friction = size;
        });
    effect.shape = {{"speed_m_per_s", shape.speed_m_per_s}, {"memory_s", shape.memory_s}};
    return effect;
}

WithheldEffect presliding(const EffectSetting&, TrialStream& draws) {
    const double softness = draws.uniform(0.0, 0.4);
    WithheldEffect effect =
        sized("presliding", "conduit", "length_m", 3e-4, 5e-3, [softness](TrueEffects& e, double size) {
            e.bristles = {size, softness};
        });
    effect.shape = {{"softness", softness}};
    return effect;
}

// The reference is where the bench usually works, so that the law changes the slope more than the level.
WithheldEffect load_dependent_friction(const EffectSetting& setting, TrialStream& draws) {
    double tension_N = 0.0;
    for (const TrialRun& run : setting.runs)
        tension_N += run.pretension_N / static_cast<double>(setting.runs.size());
    double radius_m = straight;
    for (const CurvaturePiece& piece : setting.bench.nominal.curvature)
        radius_m = std::min(radius_m, piece.bend_radius_m);
    const double reference_N_per_m = tension_N / radius_m * draws.uniform(0.9, 1.3);
    const double sign = draws.integer_below(3) == 0 ? 1.0 : -1.0;
    WithheldEffect effect = sized("load_dependent_friction", "conduit", "exponent_off_1", 0.08, 0.6,
                                  [=](TrueEffects& e, double size) {
                                      e.load_dependence = {1.0 + sign * size, reference_N_per_m};
                                  });
    effect.shape = {{"reference_N_per_m", reference_N_per_m}, {"sign", sign}};
    return effect;
}

WithheldEffect bending_stiffness(const EffectSetting&, TrialStream&) {
    return sized("bending_stiffness", "conduit", "drag_N_per_m", 0.1, 3.0,
                 [](TrueEffects& e, double size) { e.constant_drag_N_per_m = size; });
}

WithheldEffect local_bend(const EffectSetting& setting, TrialStream& draws) {
    const double middle_m = draws.uniform(0.1, 0.9) * setting.bench.length_m();
    const double half_m = 0.5 * draws.uniform(0.08, 0.25);
    const Stretch where{middle_m - half_m, middle_m + half_m};
    const int drawn = draws.integer_below(4);
    const BentCable cables = !setting.bench.is_pair() || drawn < 2 ? BentCable::both
                             : drawn == 2                          ? BentCable::a
                                                                   : BentCable::b;
    WithheldEffect effect =
        sized("local_bend", "conduit", "angle_rad", 0.2, 4.0, [=](TrueEffects& e, double size) {
            e.local_bend = {where, size, cables};
        });
    effect.where = where;
    effect.shape = {{"cables_0_both_1_a_2_b", static_cast<double>(cables)}};
    return effect;
}

WithheldEffect moving_bend(const EffectSetting& setting, TrialStream& draws) {
    const double middle_m = draws.uniform(0.15, 0.85) * setting.bench.length_m();
    const Stretch where{middle_m - 0.15, middle_m + 0.15};
    const double sign = draws.sign();
    WithheldEffect effect =
        sized("moving_bend", "conduit", "angle_per_load_angle", 0.5, 5.0, [=](TrueEffects& e, double size) {
            e.moving_bend = {where, sign * size};
        });
    effect.where = where;
    effect.shape = {{"sign", sign}};
    return effect;
}

WithheldEffect pulley_friction(const EffectSetting&, TrialStream& draws) {
    const double viscous_s = draws.uniform(0.0, 0.1);  // per newton metre of Coulomb friction
    const bool at_motor = draws.integer_below(2) == 0;
    WithheldEffect effect = at_motor ? sized("pulley_friction", "motor", "coulomb_Nm", 3e-3, 0.08,
                                             [=](TrueEffects& e, double size) {
                                                 e.motor_bearing = {size, 0.1 * viscous_s * size};
                                             })
                                     : sized("pulley_friction", "load_pulley", "coulomb_Nm", 0.02, 1.0,
                                             [=](TrueEffects& e, double size) {
                                                 e.load_bearing = {size, viscous_s * size};
                                             });
    effect.shape = {{"viscous_per_coulomb_s", at_motor ? 0.1 * viscous_s : viscous_s}};
    return at_end(effect, at_motor ? "motor" : "load");
}

WithheldEffect motor_cogging(const EffectSetting&, TrialStream& draws) {
    constexpr double slots[] = {4, 5, 6, 7, 8, 9, 10, 12, 14};
    const double periods = slots[draws.integer_below(static_cast<int>(std::size(slots)))];
    const double phase_rad = draws.uniform(-3.14, 3.14);
    WithheldEffect effect =
        sized("motor_cogging", "motor", "amplitude_Nm", 2e-3, 0.05, [=](TrueEffects& e, double size) {
            e.cogging = {size, periods, phase_rad};
        });
    effect.end = "motor";
    effect.shape = {{"periods_per_turn", periods}, {"phase_rad", phase_rad}};
    return effect;
}

WithheldEffect inertia(const EffectSetting&, TrialStream& draws) {
    if (draws.integer_below(2) == 0)
        return at_end(sized("inertia", "motor", "inertia_kg_m2", 4e-5, 3e-3,
                            [](TrueEffects& e, double size) { e.extra_rotor_inertia_kg_m2 = size; }),
                      "motor");
    return at_end(sized("inertia", "load_pulley", "inertia_kg_m2", 1e-3, 0.1,
                        [](TrueEffects& e, double size) { e.extra_load_inertia_kg_m2 = size; }),
                  "load");
}

WithheldEffect backlash(const EffectSetting&, TrialStream& draws) {
    if (draws.integer_below(2) == 0)
        return at_end(sized("backlash", "motor", "half_gap_rad", 2e-3, 0.1,
                            [](TrueEffects& e, double size) { e.motor_half_gap_rad = size; }),
                      "motor");
    return at_end(sized("backlash", "load_pulley", "half_gap_rad", 1e-3, 0.1,
                        [](TrueEffects& e, double size) { e.load_half_gap_rad = size; }),
                  "load");
}

WithheldEffect conduit_compliance(const EffectSetting&, TrialStream& draws) {
    if (draws.integer_below(2) == 0)
        return at_end(sized("conduit_compliance", "conduit", "compliance_m_per_N", 2e-5, 2e-3,
                            [](TrueEffects& e, double size) { e.motor_sheath_m_per_N = size; }),
                      "motor");
    return at_end(sized("conduit_compliance", "conduit", "compliance_m_per_N", 2e-5, 2e-3,
                        [](TrueEffects& e, double size) { e.load_sheath_m_per_N = size; }),
                  "load");
}

WithheldEffect cable_stiffness_nonlinear(const EffectSetting& setting, TrialStream& draws) {
    const double tension_N = setting.runs.front().pretension_N * draws.uniform(0.4, 1.2);
    WithheldEffect effect = sized("cable_stiffness_nonlinear", "cable", "toe_strain", 5e-4, 0.02,
                                  [tension_N](TrueEffects& e, double size) {
                                      e.toe = {size, tension_N};
                                  });
    effect.shape = {{"toe_tension_N", tension_N}};
    return effect;
}

WithheldEffect creep(const EffectSetting&, TrialStream& draws) {
    const double time_s = draws.log_uniform(0.6, 4.0);
    WithheldEffect effect =
        sized("creep", "cable", "compliance_ratio", 0.15, 2.0, [time_s](TrueEffects& e, double size) {
            e.creep = {size, time_s};
        });
    effect.shape = {{"time_constant_s", time_s}};
    return effect;
}

WithheldEffect pretension_drift(const EffectSetting&, TrialStream& draws) {
    const double time_s = draws.uniform(100.0, 400.0);
    WithheldEffect effect =
        sized("pretension_drift", "cable", "lost", 0.3, 0.9, [time_s](TrueEffects& e, double size) {
            e.drift = {size, time_s};
        });
    effect.shape = {{"time_s", time_s}};
    return effect;
}

WithheldEffect environment_coupling(const EffectSetting&, TrialStream& draws) {
    // Damping that grows with stiffness: a grip, not a bell.
    const double time_s = draws.log_uniform(3e-3, 2e-2);
    WithheldEffect effect = sized("environment_coupling", "environment", "compliance_rad_per_Nm", 3e-3, 0.1,
                                  [time_s](TrueEffects& e, double size) {
                                      if (size > 0.0) e.coupling = {size, time_s / size};
                                  });
    effect.end = "load";
    effect.shape = {{"damping_per_stiffness_s", time_s}};
    return effect;
}

// Of the channels that a model predicts: most often the load torque.
std::string draw_channel(const EffectSetting& setting, TrialStream& draws) {
    if (draws.uniform(0.0, 1.0) < 0.6) return channel::load_torque;
    std::vector<std::string> others = {setting.bench.is_pair() ? channel::motor_angle
                                                               : channel::motor_torque};
    for (const TensionSensor& sensor : setting.bench.tension_sensors) others.push_back(sensor.channel);
    return others[static_cast<std::size_t>(draws.integer_below(static_cast<int>(others.size())))];
}

WithheldEffect sensor_fault(const std::string& name, const std::string& channel, const std::string& size_name,
                            double first_size, double largest_size,
                            std::function<void(TrueSensorFault&, double)> set) {
    WithheldEffect effect = sized(
        name, "sensor:" + channel, size_name, first_size, largest_size,
        [channel, set = std::move(set)](TrueEffects& e, double size) { set(e.sensors[channel], size); });
    effect.kind += ":" + channel;
    effect.only_sensors = true;
    return effect;
}

WithheldEffect sensor_gain(const EffectSetting& setting, TrialStream& draws) {
    const double sign = draws.sign();
    return sensor_fault("sensor_gain", draw_channel(setting, draws), "gain_off_1", 0.03, 0.5,
                        [sign](TrueSensorFault& f, double size) { f.gain = 1.0 + sign * size; });
}

WithheldEffect sensor_offset(const EffectSetting& setting, TrialStream& draws) {
    const std::string channel = draw_channel(setting, draws);
    const double sign = draws.sign();
    const double span = setting.spans.at(channel);
    return sensor_fault("sensor_offset", channel, "offset", 0.02 * span, 0.5 * span,
                        [sign](TrueSensorFault& f, double size) { f.offset = sign * size; });
}

WithheldEffect sensor_lag(const EffectSetting& setting, TrialStream& draws) {
    return sensor_fault("sensor_lag", draw_channel(setting, draws), "lag_s", 0.01, 0.3,
                        [](TrueSensorFault& f, double size) { f.lag_s = size; });
}

WithheldEffect time_misalignment(const EffectSetting& setting, TrialStream& draws) {
    const double sign = draws.sign();
    return sensor_fault("time_misalignment", draw_channel(setting, draws), "delay_s", 0.01, 0.3,
                        [sign](TrueSensorFault& f, double size) { f.delay_s = sign * size; });
}

WithheldEffect sensor_quantization(const EffectSetting& setting, TrialStream& draws) {
    const std::string channel = draw_channel(setting, draws);
    const double span = setting.spans.at(channel);
    return sensor_fault("sensor_quantization", channel, "step", 0.04 * span, 0.5 * span,
                        [](TrueSensorFault& f, double size) { f.step = size; });
}

WithheldEffect sensor_hysteresis(const EffectSetting& setting, TrialStream& draws) {
    const std::string channel = draw_channel(setting, draws);
    const double span = setting.spans.at(channel);
    return sensor_fault("sensor_hysteresis", channel, "half_width", 0.02 * span, 0.3 * span,
                        [](TrueSensorFault& f, double size) { f.hysteresis = size; });
}

WithheldEffect wrong_parameter(const std::string& name, double TrueEffects::*ratio, TrialStream& draws) {
    const double sign = draws.sign();
    WithheldEffect effect = sized(name, "parameter", "log_ratio", 0.08, 0.6,
                                  [=](TrueEffects& e, double size) { e.*ratio *= std::exp(sign * size); });
    effect.shape = {{"sign", sign}};
    return effect;
}

WithheldEffect param_mu(const EffectSetting&, TrialStream& draws) {
    return wrong_parameter("param_mu", &TrueEffects::friction_ratio, draws);
}

WithheldEffect param_K(const EffectSetting&, TrialStream& draws) {
    return wrong_parameter("param_K", &TrueEffects::stiffness_ratio, draws);
}

WithheldEffect param_T0(const EffectSetting&, TrialStream& draws) {
    return wrong_parameter("param_T0", &TrueEffects::pretension_ratio, draws);
}

}  // namespace

const std::vector<EffectMaker>& catalogue_effects() {
    static const std::vector<EffectMaker> all = {
        {"viscous_friction", "", false, false, viscous_friction},
        {"stribeck", "", false, false, stribeck},
        {"presliding", "", false, false, presliding},
        {"load_dependent_friction", "", false, false, load_dependent_friction},
        {"bending_stiffness", "", false, false, bending_stiffness},
        {"local_bend", "", false, false, local_bend},
        {"moving_bend", "", true, true, moving_bend},
        {"pulley_friction", "", true, true, pulley_friction},
        {"motor_cogging", "", true, true, motor_cogging},
        {"inertia", "", true, true, inertia},
        {"backlash", "", true, false, backlash},
        {"conduit_compliance", "", false, false, conduit_compliance},
        {"cable_stiffness_nonlinear", "", false, false, cable_stiffness_nonlinear},
        {"creep", "", false, false, creep},
        {"pretension_drift", "", false, false, pretension_drift},
        {"environment_coupling", "", true, true, environment_coupling},
        {"sensor_gain", "", false, false, sensor_gain},
        {"sensor_offset", "", false, false, sensor_offset},
        {"sensor_lag", "", false, false, sensor_lag},
        {"time_misalignment", "", false, false, time_misalignment},
        {"sensor_quantization", "", false, false, sensor_quantization},
        {"sensor_hysteresis", "", false, false, sensor_hysteresis},
    };
    return all;
}

const std::vector<EffectMaker>& wrong_parameters() {
    static const std::vector<EffectMaker> all = {
        {"param_mu", "", false, false, param_mu},
        {"param_K", "", false, false, param_K},
        {"param_T0", "", false, false, param_T0},
    };
    return all;
}

}  // namespace capstan::gap_trial
