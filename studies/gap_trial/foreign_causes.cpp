#include <algorithm>

#include "capstan/gap_trial/withheld_effect.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap_trial {

namespace {

WithheldEffect foreign(const std::string& kind, const std::string& size_name, double first_size,
                       double largest_size, std::function<void(TrueEffects&, double)> apply) {
    WithheldEffect effect;
    effect.effect = "unknown";
    effect.kind = kind;
    effect.size_name = size_name;
    effect.first_size = first_size;
    effect.largest_size = largest_size;
    effect.apply = std::move(apply);
    return effect;
}

// A random instant in the middle half of a random run.
double moment_in_session_s(const EffectSetting& setting, TrialStream& draws) {
    const TrialRun& run =
        setting.runs[static_cast<std::size_t>(draws.integer_below(static_cast<int>(setting.runs.size())))];
    return run.session_start_s + run.duration_s() * draws.uniform(0.25, 0.75);
}

WithheldEffect lobed_load_pulley(const EffectSetting&, TrialStream& draws) {
    const LobedPulley shape{0.0, draws.uniform(10.0, 25.0), draws.uniform(-3.14, 3.14)};
    WithheldEffect effect =
        foreign("lobed_load_pulley", "fraction", 0.02, 0.5, [shape](TrueEffects& e, double size) {
            e.lobed_pulley = shape;
            e.lobed_pulley.fraction = size;
        });
    effect.shape = {{"lobes", shape.lobes}, {"phase_rad", shape.phase_rad}};
    return effect;
}

WithheldEffect frictional_heating(const EffectSetting&, TrialStream& draws) {
    const double sign = draws.sign();
    const double cooling_s = draws.uniform(6.0, 20.0);
    WithheldEffect effect =
        foreign("frictional_heating", "gain_at_1_J_per_m", 0.1, 3.0, [=](TrueEffects& e, double size) {
            e.heating = {sign * size, 1.0, cooling_s};
        });
    effect.shape = {{"sign", sign}, {"cooling_s", cooling_s}};
    return effect;
}

WithheldEffect one_way_friction(const EffectSetting&, TrialStream& draws) {
    const double sign = draws.sign();
    WithheldEffect effect =
        foreign("one_way_friction", "fraction", 0.1, 0.9,
                [sign](TrueEffects& e, double size) { e.one_way_friction = sign * size; });
    effect.shape = {{"sign", sign}};
    return effect;
}

WithheldEffect strand_break(const EffectSetting& setting, TrialStream& draws) {
    const double time_s = moment_in_session_s(setting, draws);
    WithheldEffect effect =
        foreign("strand_break", "fraction", 0.1, 0.85, [time_s](TrueEffects& e, double size) {
            e.strand_break = {size, time_s};
        });
    effect.shape = {{"session_time_s", time_s}};
    return effect;
}

WithheldEffect pretension_dip(const EffectSetting& setting, TrialStream& draws) {
    const double time_s = moment_in_session_s(setting, draws);
    const double width_s = draws.uniform(1.0, 3.0);
    WithheldEffect effect =
        foreign("pretension_dip", "fraction", 0.3, 0.98, [=](TrueEffects& e, double size) {
            e.dip = {size, time_s, width_s};
        });
    effect.shape = {{"session_time_s", time_s}, {"width_s", width_s}};
    return effect;
}

WithheldEffect load_torque_hum(const std::string& kind, double frequency_Hz, const EffectSetting& setting) {
    const double span = setting.spans.at(channel::load_torque);
    WithheldEffect effect =
        foreign(kind, "amplitude_Nm", 0.02 * span, 0.5 * span, [frequency_Hz](TrueEffects& e, double size) {
            e.sensors[channel::load_torque].hum = size;
            e.sensors[channel::load_torque].hum_Hz = frequency_Hz;
        });
    effect.shape = {{"frequency_Hz", frequency_Hz}};
    effect.only_sensors = true;
    return effect;
}

WithheldEffect interference(const EffectSetting& setting, TrialStream& draws) {
    return load_torque_hum("load_torque_interference", draws.log_uniform(0.6, 6.0), setting);
}

WithheldEffect wander(const EffectSetting& setting, TrialStream& draws) {
    return load_torque_hum("load_torque_wander", 1.0 / draws.uniform(5.0, 12.0), setting);
}

WithheldEffect clipping(const EffectSetting& setting, TrialStream&) {
    const double highest = 0.5 * setting.spans.at(channel::load_torque);
    WithheldEffect effect =
        foreign("load_torque_clipping", "fraction_cut_off", 0.1, 0.7, [highest](TrueEffects& e, double size) {
            if (size > 0.0) e.sensors[channel::load_torque].clipped_above = (1.0 - size) * highest;
        });
    effect.shape = {{"highest_Nm", highest}};
    effect.only_sensors = true;
    return effect;
}

}  // namespace

const std::vector<EffectMaker>& foreign_causes() {
    static const std::vector<EffectMaker> all = {
        {"unknown", "lobed_load_pulley", true, true, lobed_load_pulley},
        {"unknown", "frictional_heating", false, false, frictional_heating},
        {"unknown", "one_way_friction", false, false, one_way_friction},
        {"unknown", "strand_break", false, false, strand_break},
        {"unknown", "pretension_dip", false, false, pretension_dip},
        {"unknown", "load_torque_interference", false, false, interference},
        {"unknown", "load_torque_wander", false, false, wander},
        {"unknown", "load_torque_clipping", true, false, clipping},
    };
    return all;
}

}  // namespace capstan::gap_trial
