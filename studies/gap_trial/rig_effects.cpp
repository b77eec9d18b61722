#include "capstan/gap_trial/rig_effects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "capstan/rig/channel_names.h"

namespace capstan::gap_trial {

namespace {

// The catalogue's drawing of an effect, with its size, component and end.
WithheldEffect as_in_catalogue(std::string_view effect, const EffectSetting& setting, TrialStream& draws) {
    const std::vector<EffectMaker>& makers = catalogue_effects();
    return std::find_if(makers.begin(), makers.end(),
                        [&](const EffectMaker& maker) { return maker.effect == effect; })
        ->draw(setting, draws);
}

// The same effect with a change of its form after its size is set.
WithheldEffect reshaped(WithheldEffect effect, std::function<void(TrueEffects&, double)> change) {
    effect.apply = [inner = std::move(effect.apply), change = std::move(change)](TrueEffects& e,
                                                                                 double size) {
        inner(e, size);
        change(e, size);
    };
    return effect;
}

WithheldEffect rational_stribeck(const EffectSetting& setting, TrialStream& draws) {
    const double power = draws.uniform(1.0, 3.0);
    WithheldEffect effect = reshaped(as_in_catalogue("stribeck", setting, draws),
                                     [power](TrueEffects& e, double) { e.stribeck.power = power; });
    effect.shape["power"] = power;
    return effect;
}

WithheldEffect slip_elements(const EffectSetting& setting, TrialStream& draws) {
    if (draws.integer_below(2) == 0) return as_in_catalogue("presliding", setting, draws);
    WithheldEffect effect = as_in_catalogue("presliding", setting, draws);
    effect.kind = "presliding_slip_elements";
    effect.shape.clear();
    effect.apply = [](TrueEffects& e, double size) { e.slip_elements.length_m = size; };
    return effect;
}

WithheldEffect saturating_contact(const EffectSetting& setting, TrialStream& draws) {
    WithheldEffect effect = as_in_catalogue("load_dependent_friction", setting, draws);
    const double reference_N_per_m = effect.shape.at("reference_N_per_m");
    const double sign = -effect.shape.at("sign");
    effect.size_name = "weight";
    effect.first_size = 0.2;
    effect.largest_size = 0.9;
    effect.apply = [=](TrueEffects& e, double size) {
        e.saturating_contact = {sign * size, reference_N_per_m};
    };
    return effect;
}

WithheldEffect uneven_cogging(const EffectSetting& setting, TrialStream& draws) {
    const double second = draws.uniform(0.0, 0.35);
    WithheldEffect effect =
        reshaped(as_in_catalogue("motor_cogging", setting, draws),
                 [second](TrueEffects& e, double) { e.cogging.second_harmonic = second; });
    effect.shape["second_harmonic"] = second;
    effect.first_size = 0.02 * setting.spans.at(channel::motor_torque);
    return effect;
}

WithheldEffect spread_creep(const EffectSetting& setting, TrialStream& draws) {
    const double fraction = draws.uniform(0.4, 0.7);
    const double factor = draws.uniform(3.0, 8.0);
    WithheldEffect effect = reshaped(as_in_catalogue("creep", setting, draws), [=](TrueEffects& e, double) {
        e.creep.fast_fraction = fraction;
        e.creep.slow_factor = factor;
    });
    effect.shape["fast_fraction"] = fraction;
    effect.shape["slow_factor"] = factor;
    return effect;
}

// A sensor's fault on a channel that a model of this rig predicts.
WithheldEffect fault_on(const EffectSetting& setting, const std::string& name, const std::string& size_name,
                        double first_size, double largest_size, TrialStream& draws,
                        std::function<void(TrueSensorFault&, double)> set) {
    WithheldEffect effect = as_in_catalogue(name, setting, draws);
    const bool of_torque = draws.integer_below(2) == 0;
    const std::string channel = !setting.bench.is_drive()
                                    ? effect.component.substr(std::string_view("sensor:").size())
                                : of_torque ? channel::motor_torque
                                            : channel::load_angle;
    effect.component = "sensor:" + channel;
    effect.kind = name + ":" + channel;
    effect.size_name = size_name;
    const double unit = name == "sensor_lag" || name == "time_misalignment" || name == "sensor_gain"
                            ? 1.0
                            : setting.spans.at(channel);
    effect.first_size = first_size * unit;
    effect.largest_size = largest_size * unit;
    effect.apply = [=](TrueEffects& e, double size) { set(e.sensors[channel], size); };
    return effect;
}

WithheldEffect gain_fault(const EffectSetting& setting, TrialStream& draws) {
    const double sign = draws.sign();
    return fault_on(setting, "sensor_gain", "gain_off_1", 0.03, 0.5, draws,
                    [sign](TrueSensorFault& f, double size) { f.gain = 1.0 + sign * size; });
}

WithheldEffect lag_fault(const EffectSetting& setting, TrialStream& draws) {
    return fault_on(setting, "sensor_lag", "lag_s", 0.02, 0.4, draws, [](TrueSensorFault& f, double size) {
        f.lag_s = size;
        f.lag_in_two_stages = true;
    });
}

WithheldEffect delay_fault(const EffectSetting& setting, TrialStream& draws) {
    const double sign = draws.sign();
    return fault_on(setting, "time_misalignment", "delay_s", 0.02, 0.4, draws,
                    [sign](TrueSensorFault& f, double size) { f.delay_s = sign * size; });
}

WithheldEffect quantization_fault(const EffectSetting& setting, TrialStream& draws) {
    return fault_on(setting, "sensor_quantization", "step", 0.03, 0.4, draws,
                    [](TrueSensorFault& f, double size) { f.step = size; });
}

WithheldEffect hysteresis_fault(const EffectSetting& setting, TrialStream& draws) {
    const double spread = draws.uniform(0.2, 0.6);
    return fault_on(setting, "sensor_hysteresis", "half_width", 0.02, 0.3, draws,
                    [spread](TrueSensorFault& f, double size) {
                        f.hysteresis = size;
                        f.hysteresis_spread = spread;
                    });
}

WithheldEffect motor_backlash(const EffectSetting&, TrialStream&) {
    WithheldEffect effect;
    effect.effect = "backlash";
    effect.kind = "backlash_motor";
    effect.component = effect.end = "motor";
    effect.size_name = "half_gap_rad";
    effect.first_size = 5e-3;
    effect.largest_size = 0.2;
    effect.apply = [](TrueEffects& e, double size) { e.motor_half_gap_rad = size; };
    return effect;
}

const std::vector<EffectMaker>& own_forms() {
    static const std::vector<EffectMaker> all = {
        {"stribeck", "", false, false, rational_stribeck},
        {"presliding", "", false, false, slip_elements},
        {"load_dependent_friction", "", false, false, saturating_contact},
        {"motor_cogging", "", true, true, uneven_cogging},
        {"creep", "", false, false, spread_creep},
        {"sensor_gain", "", false, false, gain_fault},
        {"sensor_lag", "", false, false, lag_fault},
        {"time_misalignment", "", false, false, delay_fault},
        {"sensor_quantization", "", false, false, quantization_fault},
        {"sensor_hysteresis", "", false, false, hysteresis_fault},
    };
    return all;
}

// Shown by the torque of the motor and the angle of the load, whatever the geometry is.
constexpr std::array<std::string_view, 13> shown_by_a_drive = {
    "viscous_friction", "stribeck",      "presliding",       "load_dependent_friction",   "bending_stiffness",
    "moving_bend",      "motor_cogging", "backlash",         "cable_stiffness_nonlinear", "creep",
    "pretension_drift", "sensor_lag",    "time_misalignment"};
constexpr std::array<std::string_view, 2> nuisance_effects = {"pulley_friction", "sensor_offset"};

template <typename Names>
bool is_in(const Names& names, const std::string& effect) {
    return std::find(names.begin(), names.end(), effect) != names.end();
}

}  // namespace

std::vector<EffectMaker> with_own_forms(std::vector<EffectMaker> makers) {
    for (EffectMaker& maker : makers) {
        for (const EffectMaker& form : own_forms()) {
            if (form.effect == maker.effect) maker = form;
        }
    }
    return makers;
}

std::vector<EffectMaker> rig_effects(BenchKind kind) {
    std::vector<EffectMaker> makers = with_own_forms(catalogue_effects());
    std::erase_if(makers, [](const EffectMaker& maker) { return is_in(nuisance_effects, maker.effect); });
    if (kind != BenchKind::rig_drive) return makers;
    std::erase_if(makers, [](const EffectMaker& maker) { return !is_in(shown_by_a_drive, maker.effect); });
    for (EffectMaker& maker : makers) {
        maker.needs_motion = false;  // every run of a drive moves its load
        if (maker.effect == "backlash") maker.draw = motor_backlash;
    }
    return makers;
}

WithheldEffect draw_varying_number(const EffectSetting& setting, const std::string& condition,
                                   TrialStream& draws) {
    using Which = ConditionedNumber::Which;
    constexpr std::array<Which, 3> numbers = {Which::friction, Which::pretension, Which::zero};
    ConditionedNumber number;
    number.which = numbers[static_cast<std::size_t>(draws.integer_below(3))];
    number.condition = condition;
    number.squared = draws.integer_below(2) == 0;
    for (const TrialRun& run : setting.runs)
        number.scale = std::max(number.scale, std::abs(run.conditions.at(condition)));
    const double sign = draws.sign();
    WithheldEffect effect;
    effect.kind = "varying";
    effect.first_size = 0.1;
    effect.largest_size = 0.9;
    switch (number.which) {
        case Which::friction:
            effect.effect = "param_mu";
            effect.component = "parameter";
            effect.size_name = "log_ratio_at_largest_condition";
            break;
        case Which::pretension:
            effect.effect = "param_T0";
            effect.component = "parameter";
            effect.size_name = "log_ratio_at_largest_condition";
            break;
        case Which::zero:
            // A driven sensor's zero would move the inputs instead.
            number.channel = setting.bench.is_pair() && !setting.bench.is_drive() ? channel::load_torque
                                                                                  : channel::motor_torque;
            effect.effect = "sensor_offset";
            effect.component = "sensor:" + number.channel;
            effect.size_name = "offset_at_largest_condition";
            effect.first_size = 0.03 * setting.spans.at(number.channel);
            effect.largest_size = 0.5 * setting.spans.at(number.channel);
            effect.only_sensors = true;
            break;
    }
    effect.varies = condition;
    effect.shape = {{"squared", number.squared ? 1.0 : 0.0}, {"sign", sign}};
    effect.apply = [number, sign](TrueEffects& e, double size) {
        ConditionedNumber sized = number;
        sized.amount = sign * size;
        e.conditioned.push_back(sized);
    };
    return effect;
}

}  // namespace capstan::gap_trial
