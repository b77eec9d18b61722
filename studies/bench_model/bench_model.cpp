#include "capstan/bench_model/bench_model.h"

#include <algorithm>

#include "capstan/bench_model/effect_numbers.h"
#include "capstan/bench_model/model_keys.h"
#include "capstan/effects/sensor_faults.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/rig/channel_names.h"

namespace capstan::bench_model {

namespace {

using gap::BenchNumbers;
using gap::FittedCause;

std::string unit_of_channel(const Recording& recording, const std::string& name) {
    const auto channel = recording.channel(name);
    return channel ? recording.channels[static_cast<std::size_t>(*channel)].unit : "";
}

std::vector<ModelSensor> sensors_of(const std::map<std::string, SensorFaults>& by_channel,
                                    const Recording& bench) {
    std::vector<ModelSensor> sensors;
    for (const auto& [channel, faults] : by_channel) {
        ModelSensor sensor{channel, {}};
        for (const FaultKey& fault : fault_keys()) {
            const double value = faults.*fault.value;
            if (value == SensorFaults().*fault.value) continue;
            sensor.faults.push_back(
                {fault.name, fault.in_channel_unit ? unit_of_channel(bench, channel) : fault.unit, value});
        }
        if (!sensor.faults.empty()) sensors.push_back(std::move(sensor));
    }
    return sensors;
}

std::vector<ModelFollowing> following_of(const std::vector<BenchNumbers::Following>& given,
                                         const Recording& bench) {
    std::vector<ModelFollowing> all;
    for (const BenchNumbers::Following& each : given) {
        if (all.empty() || all.back().condition != each.condition)
            all.push_back({each.condition, each.middle, each.half_range, {}});
        std::vector<FittedNumber>& changes = all.back().changes;
        const bool is_zero = each.what == BenchNumbers::Following::What::zero;
        const std::string what = is_zero ? zero_change + each.channel
                                 : each.what == BenchNumbers::Following::What::friction ? friction_change
                                                                                        : pretension_change;
        const std::string unit = is_zero ? unit_of_channel(bench, each.channel) : "";
        changes.push_back({what, unit, each.linear});
        if (each.squared != 0.0) changes.push_back({squared_change + what, unit, each.squared});
    }
    return all;
}

// The number of a list with this name; null: there is none.
FittedNumber* named(std::vector<FittedNumber>& numbers, const std::string& name) {
    for (FittedNumber& each : numbers)
        if (each.name == name) return &each;
    return nullptr;
}

// Which numbers of the model are those that were fitted, so that they get the intervals.
class FittedNumbers {
  public:
    explicit FittedNumbers(BenchModel& model) : model_(model) {}

    void take(const FittedCause& cause) {
        for (const FittedNumber& fitted : cause.numbers)
            if (FittedNumber* number = number_of(cause, fitted.name)) number->interval = fitted.interval;
    }

    // A number of the bench that floated stands for whatever changes with it, in that one's own unit.
    void take(const gap::FloatingNumber& floating, const FittedNumber& fitted) {
        if (!fitted.interval) return;
        const auto with = [&](double value) {
            BenchNumbers numbers;
            floating.apply(numbers, value);
            return numbers;
        };
        BenchNumbers low = with(fitted.interval->low);
        BenchNumbers high = with(fitted.interval->high);
        BenchNumbers present = with(fitted.value);
        const auto take = [](FittedNumber& number, double value, double one_end, double other_end) {
            if (!number.interval && number.value == value && one_end != other_end)
                number.interval = {std::min(one_end, other_end), std::max(one_end, other_end)};
        };
        take(model_.bend_at_motor_ratio, present.bend_at_motor_ratio, low.bend_at_motor_ratio,
             high.bend_at_motor_ratio);
        take(model_.bend_at_load_ratio, present.bend_at_load_ratio, low.bend_at_load_ratio,
             high.bend_at_load_ratio);
        take(model_.load_radius_ratio, present.load_radius_ratio, low.load_radius_ratio,
             high.load_radius_ratio);
        for (ModelSensor& sensor : model_.sensors) {
            for (const FaultKey& fault : fault_keys()) {
                const auto of = [&](BenchNumbers& numbers) {
                    return numbers.sensor_faults[sensor.channel].*fault.value;
                };
                if (FittedNumber* number = named(sensor.faults, fault.name))
                    take(*number, of(present), of(low), of(high));
            }
        }
        for (ModelEffect& effect : model_.effects) {
            const EffectNumbers& group = *find_effect(effect.name, effect.variant);
            const auto values = group.values_in(present.effects);
            const auto at_low = group.values_in(low.effects);
            const auto at_high = group.values_in(high.effects);
            for (std::size_t k = 0; values && at_low && at_high && k < values->size(); ++k)
                take(effect.numbers[k], (*values)[k], (*at_low)[k], (*at_high)[k]);
        }
    }

  private:
    FittedNumber* number_of(const FittedCause& cause, const std::string& name) {
        for (ModelFollowing& follows : model_.follows) {
            if (!cause.variant.ends_with("with " + follows.condition)) continue;
            const std::string what = cause.effect == "param_mu"   ? friction_change
                                     : cause.effect == "param_T0" ? pretension_change
                                                                  : zero_change + first_word(cause.variant);
            const bool is_squared = name.starts_with(squared_change);
            if (FittedNumber* number = named(follows.changes, (is_squared ? squared_change : "") + what))
                return number;
        }
        for (ModelEffect& effect : model_.effects)
            if (effect.name == cause.effect && effect.variant == cause.variant)
                return named(effect.numbers, name);
        for (ModelSensor& sensor : model_.sensors) {
            for (std::size_t k = 0; k < sensor_fault_catalogue().size(); ++k) {
                const SensorFault& fault = sensor_fault_catalogue()[k];
                if (cause.effect == fault.name && cause.variant == fault.variant_at(sensor.channel))
                    return named(sensor.faults, name == fault.shape.name ? name : fault_keys()[k].name);
            }
        }
        return nullptr;
    }

    static std::string first_word(const std::string& text) { return text.substr(0, text.find(' ')); }

    BenchModel& model_;
};

void take_intervals(BenchModel& model, const gap::Diagnosis& diagnosis, const Recording& bench) {
    FittedNumbers fitted(model);
    for (const FittedCause& cause : diagnosis.causes) fitted.take(cause);
    if (diagnosis.bench.empty()) return;
    const gap::BenchKnowledge known =
        bench.nominal_is_fitted ? gap::undescribed_bench(bench) : gap::built_bench(bench);
    for (const FittedNumber& number : diagnosis.bench) {
        for (const gap::FloatingNumber& floating : known.numbers)
            if (floating.name == number.name) fitted.take(floating, number);
    }
}

double present(const gap::Diagnosis& diagnosis, const std::string& effect) {
    for (const gap::RankedEffect& each : diagnosis.ranked)
        if (each.effect == effect) return each.present;
    return 0.0;
}

ModelLaw law_of(const model_comparison::LeftOver& left, const Recording& recording) {
    const auto name = [&](std::size_t channel) { return recording.channels[channel].name; };
    return {.channel = name(left.channels.output),
            .motion = name(left.channels.motion),
            .load = left.channels.load ? name(*left.channels.load) : "",
            .unit = left.names.output_unit,
            .motion_unit = left.names.motion_unit,
            .load_unit = left.names.load_unit,
            .law = left.law,
            .sentence = residual_law::law_sentence(left.law, left.names)};
}

gap::BenchEquivalence description_of(const model_comparison::DiagnosedSplit& split) {
    gap::BenchEquivalence description;
    if (split.equivalence) description = *split.equivalence;
    description.bench = *split.diagnosed.nominal;
    if (split.recorded.mode == BenchMode::lumped_drive) return description;
    description.pretension_N = 0.0;
    for (const RecordedRun& run : split.diagnosed.runs)
        description.pretension_N +=
            run.pretension_N.value_or(0.0) / static_cast<double>(split.diagnosed.runs.size());
    return description;
}

double tension_noise_of(const Recording& recorded, const NominalBench& bench) {
    const Recording known = with_estimated_noise(recorded);
    const auto noise_of = [&](std::string_view name) {
        const auto channel = known.channel(name);
        return channel ? sample_noise(known.channels[static_cast<std::size_t>(*channel)]) : 0.0;
    };
    double noise_N = 0.0;
    for (const TensionSensor& sensor : known.tension_sensors)
        noise_N = std::max(noise_N, noise_of(sensor.channel));
    if (!known.tension_sensors.empty()) return noise_N;
    return std::max(noise_of(channel::motor_torque) / bench.motor_radius_m,
                    noise_of(channel::load_torque) / bench.load_radius_m);
}

}  // namespace

bool BenchModel::is_of_unknown_geometry() const {
    return recorded_mode == BenchMode::lumped_drive || recorded_mode == BenchMode::capstan_band;
}

BenchNumbers BenchModel::numbers() const {
    BenchNumbers numbers;
    numbers.friction_ratio = friction_ratio.value;
    numbers.stiffness_ratio = stiffness_ratio.value;
    numbers.pretension_ratio = pretension_ratio.value;
    numbers.bend_at_motor_ratio = bend_at_motor_ratio.value;
    numbers.bend_at_load_ratio = bend_at_load_ratio.value;
    numbers.load_radius_ratio = load_radius_ratio.value;
    numbers.effects = effects_with(effects);
    for (const ModelSensor& sensor : sensors) {
        for (const FaultKey& fault : fault_keys())
            for (const FittedNumber& number : sensor.faults)
                if (number.name == fault.name)
                    numbers.sensor_faults[sensor.channel].*fault.value = number.value;
    }
    for (const ModelFollowing& each : follows) {
        for (const FittedNumber& change : each.changes) {
            if (change.name.starts_with(squared_change)) continue;
            using What = BenchNumbers::Following::What;
            BenchNumbers::Following follows_it;
            follows_it.what = change.name == friction_change     ? What::friction
                              : change.name == pretension_change ? What::pretension
                                                                 : What::zero;
            if (follows_it.what == What::zero)
                follows_it.channel = change.name.substr(std::string_view(zero_change).size());
            follows_it.condition = each.condition;
            follows_it.middle = each.middle;
            follows_it.half_range = each.half_range;
            follows_it.linear = change.value;
            for (const FittedNumber& other : each.changes)
                if (other.name == squared_change + change.name) follows_it.squared = other.value;
            numbers.follows.push_back(std::move(follows_it));
        }
    }
    return numbers;
}

BenchModel model_of(const model_comparison::DiagnosedSplit& split,
                    const std::vector<model_comparison::LeftOver>& left, const ModelOrigin& origin,
                    const gap::DiagnosisOptions& options) {
    const gap::Diagnosis& diagnosis = split.diagnosis;
    // A number that is added to BenchNumbers must be added to the model and its file as well; this names all.
    const auto& [friction_ratio, stiffness_ratio, pretension_ratio, bend_at_motor_ratio, bend_at_load_ratio,
                 load_radius_ratio, effects, sensor_faults, follows] = diagnosis.corrected.in_other_runs();
    BenchModel model;
    model.origin = origin;
    model.recorded_mode = split.recorded.mode;
    model.description = description_of(split);
    model.segments = options.segments;
    model.sample_rate_Hz = split.recorded.sample_rate_Hz;
    model.tension_noise_N = tension_noise_of(split.recorded, model.description.bench);
    model.friction_ratio = {"friction_ratio", "", friction_ratio, diagnosis.friction_interval};
    model.stiffness_ratio = {"stiffness_ratio", "", stiffness_ratio, diagnosis.stiffness_interval};
    model.pretension_ratio = {"pretension_ratio", "", pretension_ratio, diagnosis.pretension_interval};
    model.bend_at_motor_ratio.value = bend_at_motor_ratio;
    model.bend_at_load_ratio.value = bend_at_load_ratio;
    model.load_radius_ratio.value = load_radius_ratio;
    model.effects = described_effects(effects, diagnosis.causes);
    model.sensors = sensors_of(sensor_faults, split.diagnosed);
    model.follows = following_of(follows, split.diagnosed);
    model.ranked = diagnosis.ranked;
    for (const FittedCause& cause : diagnosis.causes)
        model.causes.push_back(
            {cause.effect, cause.variant, cause.component, cause.end, present(diagnosis, cause.effect)});
    take_intervals(model, diagnosis, split.diagnosed);
    for (const model_comparison::LeftOver& each : left) model.laws.push_back(law_of(each, split.recorded));
    return model;
}

}  // namespace capstan::bench_model
