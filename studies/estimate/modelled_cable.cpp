#include "capstan/estimate/modelled_cable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "capstan/bench_model/model_keys.h"
#include "capstan/bench_model/model_prediction.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/effects/known_causes.h"
#include "capstan/platform/statistics.h"
#include "capstan/rig/channel_names.h"

namespace capstan::estimate {

namespace {

using bench_model::BenchModel;
using bench_model::FittedNumber;
using gap::BenchNumbers;

// The factor by which a ratio is off at one standard deviation.
double deviation_factor(const FittedNumber& ratio) {
    if (!ratio.interval || !(ratio.interval->low > 0.0)) return 1.0;
    return std::exp(std::log(ratio.interval->high / ratio.interval->low) / (2.0 * two_sided_95));
}

// The same of an effect's number, which may be 0.
double deviation_factor(const BenchModel& model, const char* effect, const char* number) {
    for (const bench_model::ModelEffect& each : model.effects) {
        if (each.name != effect) continue;
        for (const FittedNumber& fitted : each.numbers) {
            if (fitted.name != number || !fitted.interval || !(fitted.value > 0.0)) continue;
            return 1.0 + (fitted.interval->high - fitted.interval->low) / (2.0 * two_sided_95 * fitted.value);
        }
    }
    return 1.0;
}

std::vector<ShiftedCable> uncertain_numbers(const BenchModel& model) {
    const std::vector<ShiftedCable> all = {
        {.friction_ratio = deviation_factor(model.friction_ratio)},
        {.stiffness_ratio = deviation_factor(model.stiffness_ratio)},
        {.pretension_ratio = deviation_factor(model.pretension_ratio)},
        {.viscous_ratio = deviation_factor(model, "viscous_friction", "drag")},
        {.stribeck_ratio = deviation_factor(model, "stribeck", "extra_friction")}};
    std::vector<ShiftedCable> uncertain;
    for (const ShiftedCable& each : all)
        if (each.is_shifted()) uncertain.push_back(each);
    return uncertain;
}

// What the sensors would have read without their zero and gain.
void correct_readings(Recording& recording, std::size_t run, const BenchNumbers& in_run) {
    for (const auto& [name, fault] : in_run.sensor_faults) {
        const auto channel = recording.channel(name);
        if (!channel) continue;
        RecordedRun& corrected = recording.runs[run];
        std::vector<double>& values = corrected.values[static_cast<std::size_t>(*channel)];
        for (std::size_t sample = 0; sample < values.size(); ++sample)
            values[sample] =
                (values[sample] - fault.zero_at(corrected.session_start_s + corrected.time_s[sample])) /
                fault.gain;
    }
}

// The recording of a bench with the model's stiffness, and each run's pretension. Friction follows by run.
Recording corrected_recording(const Recording& recording, const BenchModel& model) {
    Recording corrected = recording_of_bench(model, recording);
    const BenchNumbers numbers = numbers_for(model, corrected);
    corrected.nominal->axial_stiffness_N *= numbers.stiffness_ratio;
    for (std::size_t k = 0; k < corrected.runs.size(); ++k) {
        RecordedRun& run = corrected.runs[k];
        const BenchNumbers in_run = numbers.in_run(run);
        run.pretension_N = *run.pretension_N * in_run.pretension_ratio *
                           numbers.effects.of<PretensionDrift>().ratio(run.session_start_s);
        correct_readings(corrected, k, in_run);
    }
    for (const auto& [name, fault] : numbers.sensor_faults) {
        const auto channel = corrected.channel(name);
        if (!channel) continue;
        Channel& described = corrected.channels[static_cast<std::size_t>(*channel)];
        if (described.noise_std) *described.noise_std /= std::abs(fault.gain);
        if (described.step) *described.step /= std::abs(fault.gain);
    }
    return corrected;
}

bool has_bend(const LocalBend& bend, const std::string& cable) {
    return bend.extra_angle_rad != 0.0 &&
           (bend.cables == BentCables::both || (bend.cables == BentCables::only_a) == (cable == "A"));
}

constexpr std::array<std::string_view, 4> used_effects = {"viscous_friction", "stribeck", "local_bend",
                                                          "pretension_drift"};

constexpr std::string_view zero_of = "zero_of_";

bool is_zero(const std::string& change) {
    return change.find(zero_of) != std::string::npos;
}

std::string following_words(const bench_model::ModelFollowing& following, const std::string& change) {
    const std::string what =
        is_zero(change) ? "zero of " + channel_words(change.substr(change.find(zero_of) + zero_of.size()))
        : change.ends_with("pretension_log") ? "pretension"
                                             : "friction";
    return fmt::format("{} that follows {}", what, following.condition);
}

}  // namespace

std::vector<std::string> parts_not_used(const BenchModel& model, const UsedParts& used) {
    std::vector<std::string> unused;
    const auto add = [&](const std::string& words) {
        if (std::find(unused.begin(), unused.end(), words) == unused.end()) unused.push_back(words);
    };
    for (const bench_model::ModelEffect& effect : model.effects)
        if (std::find(used.effects.begin(), used.effects.end(), effect.name) == used.effects.end())
            add(cause_title(effect.name));
    for (const bench_model::ModelSensor& sensor : model.sensors) {
        for (const FittedNumber& fault : sensor.faults) {
            if (used.zeros_and_gains &&
                (fault.name == "gain" || fault.name == "offset" || fault.name == "change_in_100_s"))
                continue;
            // Within a sample no estimate of a sample changes.
            if (fault.name == "time_misalignment" && used.sample_rate_Hz > 0.0 &&
                std::abs(fault.value) * used.sample_rate_Hz < 1.0)
                continue;
            add(fmt::format("{} ({})", cause_title(bench_model::effect_of_fault(fault.name)),
                            channel_words(sensor.channel)));
        }
    }
    if (used.conditions) return unused;
    for (const bench_model::ModelFollowing& following : model.follows) {
        const auto& stated = used.stated_conditions;
        const bool is_stated = std::find(stated.begin(), stated.end(), following.condition) != stated.end();
        for (const FittedNumber& change : following.changes)
            if (!is_stated || is_zero(change.name)) add(following_words(following, change.name));
    }
    return unused;
}

std::vector<CurvaturePiece> with_bend(const std::vector<CurvaturePiece>& path, double from_m, double to_m,
                                      double extra_angle_rad) {
    const double extra_curvature = extra_angle_rad / (to_m - from_m);
    std::vector<CurvaturePiece> bent;
    const auto add = [&](double begin_m, double end_m, double curvature) {
        if (end_m > begin_m) bent.push_back({end_m - begin_m, curvature > 0.0 ? 1.0 / curvature : straight});
    };
    double begin_m = 0.0;
    for (const CurvaturePiece& piece : path) {
        const double end_m = begin_m + piece.length_m;
        const double low_m = std::clamp(from_m, begin_m, end_m);
        const double high_m = std::clamp(to_m, begin_m, end_m);
        const double curvature = 1.0 / piece.bend_radius_m;
        add(begin_m, low_m, curvature);
        add(low_m, high_m, curvature + extra_curvature);
        add(high_m, end_m, curvature);
        begin_m = end_m;
    }
    return bent;
}

ModelledCables modelled_cables(const Recording& recording, const BenchModel& model, int segments) {
    if (model.is_of_unknown_geometry())
        throw InvalidInput({fmt::format(
            "{}: the model is of a bench of unknown geometry, so a sensor has no place on its cable; estimating "
            "needs a model of a pull_pull or single_cable bench",
            recording.name)});
    const Recording corrected = corrected_recording(recording, model);
    const BenchNumbers numbers = numbers_for(model, corrected);
    const LocalBend& bend = numbers.effects.of<LocalBend>();
    ModelledCables modelled{sensed_cables(corrected, segments),
                            parts_not_used(model, {.effects = used_effects,
                                                   .zeros_and_gains = true,
                                                   .conditions = true,
                                                   .sample_rate_Hz = recording.sample_rate_Hz})};
    for (SensedCable& cable : modelled.cables) {
        if (has_bend(bend, cable.name))
            cable.specification.curvature = with_bend(cable.specification.curvature, bend.stretch().from_m,
                                                      bend.stretch().to_m, bend.extra_angle_rad);
        for (std::size_t run = 0; run < cable.runs.size(); ++run)
            cable.runs[run].friction_ratio = numbers.in_run(corrected.runs[run]).friction_ratio;
        cable.uncertain = uncertain_numbers(model);
        cable.rate_friction = {numbers.effects.of<ViscousFriction>(), numbers.effects.of<Stribeck>()};
    }
    return modelled;
}

}  // namespace capstan::estimate
