#include "capstan/gap/candidate_cause.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "capstan/cable/cable_cut.h"
#include "capstan/effects/effect_catalogue.h"
#include "capstan/effects/known_causes.h"
#include "capstan/recording/channel_range.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

using Values = std::span<const double>;

// Wide enough for any wrong parameter that a laboratory would not notice otherwise.
constexpr double wrong_log_std = 0.5;

// Without open numbers.
CandidateCause plain(const std::string& effect, const std::string& component) {
    CandidateCause cause;
    cause.effect = effect;
    const KnownCause* known = find_cause(effect);
    cause.family = known != nullptr ? known->family : effect;
    cause.is_outside_the_list = known != nullptr && known->answered_as == "unknown";
    cause.component = component;
    cause.apply = [](BenchNumbers&, Values) {};
    cause.is_exact = effect.starts_with("param_") || effect == "sensor_offset" || effect == "sensor_gain";
    cause.friction_std = cause.stiffness_std = cause.pretension_std = nominal_log_std;
    return cause;
}

OpenNumber::Kind kind_of(const EffectParameter& parameter, double absent) {
    switch (parameter.role) {
        case ParameterRole::shape:
        case ParameterRole::normal_force:
            return OpenNumber::Kind::shape;
        case ParameterRole::place:
            return OpenNumber::Kind::place;
        case ParameterRole::periods:
            return OpenNumber::Kind::periods;
        case ParameterRole::size:
            break;
    }
    return parameter.low < absent ? OpenNumber::Kind::signed_size : OpenNumber::Kind::size;
}

// The mean magnitude of a channel in a run; 0 where it was not recorded.
double mean_magnitude(const Recording& recording, const RecordedRun& run, const char* name) {
    const auto channel = recording.channel(name);
    if (!channel) return 0.0;
    const std::vector<double>& values = run.values[static_cast<std::size_t>(*channel)];
    double sum = 0.0;
    for (const double value : values) sum += std::abs(value);
    return sum / static_cast<double>(values.size());
}

// The mean over the runs [N].
double usual_pretension_N(const Recording& recording) {
    double pretension_N = 0.0;
    for (const RecordedRun& run : recording.runs)
        pretension_N += run.pretension_N.value_or(0.0) / static_cast<double>(recording.runs.size());
    return pretension_N;
}

// About what the cables carry, the mean over the runs [N]: the pretension, or what the torques ask for where
// that is more, as in a drive with little pretension.
double usual_tension_N(const Recording& recording) {
    const NominalBench& bench = *recording.nominal;
    double tension_N = 0.0;
    for (const RecordedRun& run : recording.runs) {
        const double of_run_N =
            std::max({run.pretension_N.value_or(0.0),
                      mean_magnitude(recording, run, channel::motor_torque) / bench.motor_radius_m,
                      mean_magnitude(recording, run, channel::load_torque) / bench.load_radius_m});
        tension_N += of_run_N / static_cast<double>(recording.runs.size());
    }
    return tension_N;
}

// Normal force per length where the cable bends most: about where a bench works.
double usual_normal_force_N_per_m(const Recording& recording) {
    double radius_m = straight;
    for (const CurvaturePiece& piece : recording.nominal->curvature)
        radius_m = std::min(radius_m, piece.bend_radius_m);
    return usual_tension_N(recording) / radius_m;
}

// How far the motor turns in the recording [rad].
double turned_rad(const Recording& recording) {
    const auto channel = recording.channel(channel::motor_angle);
    return channel ? largest_span(recording, static_cast<std::size_t>(*channel)) : 0.0;
}

// Half a step of the encoder at an end: between two counts an angle may turn back unseen, which looks like
// lost motion of that size.
double unseen_half_gap_rad(const Recording& recording, const std::string& end) {
    const auto channel = recording.channel(end == "motor" ? channel::motor_angle : channel::load_angle);
    return channel ? 0.5 * recording.channels[static_cast<std::size_t>(*channel)].step.value_or(0.0) : 0.0;
}

// Of a band whose numbers all float, an exponent that was fitted to one run makes the others worse.
bool has_given_exponent(const Recording& recording, const std::string& effect) {
    const bool is_undescribed_band = recording.nominal_is_fitted && recording.mode != BenchMode::pull_pull;
    return is_undescribed_band && effect == "presliding";
}

CandidateCause cause_of(const Effect& effect, const Recording& recording, double length_m) {
    const double turned = turned_rad(recording);
    CandidateCause cause = plain(effect.name, effect.component);
    cause.variant = effect.variant;
    cause.end = effect.end;
    cause.is_rare = effect.is_rare;
    cause.is_sought_last =
        (effect.name == "pulley_friction" && effect.parameters.front().name == "per_torque") ||
        cause.is_outside_the_list;
    std::vector<double> values = effect.absent;
    std::vector<std::size_t> open;  // parameters
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
        const EffectParameter& parameter = effect.parameters[k];
        if (parameter.role == ParameterRole::normal_force) {
            // The reference of a power law and its factor are equivalent, and the factor is the friction
            // itself.
            values[k] = usual_normal_force_N_per_m(recording);
        }
        if (parameter.role == ParameterRole::normal_force ||
            (parameter.role == ParameterRole::shape && has_given_exponent(recording, effect.name))) {
            cause.given.push_back({parameter.name, parameter.unit, values[k]});
            continue;
        }
        OpenNumber number{parameter.name,    parameter.unit,      kind_of(parameter, effect.absent[k]),
                          parameter.typical, effect.absent[k],    parameter.low,
                          parameter.high,    parameter.resonates, parameter.is_detail};
        if (number.kind == OpenNumber::Kind::place) number.typical = length_m;
        // A ripple of which less than a period was seen repeats nothing: it is any function of the position.
        // A drive has a smooth torque over the position to compare it with.
        if (number.kind == OpenNumber::Kind::periods && turned > 0.0) {
            const double seen_periods = recording.is_undescribed_drive() ? 0.5 : 1.0;
            number.low = std::clamp(std::ceil(seen_periods * 2.0 * std::numbers::pi / turned), number.low,
                                    number.high);
        }
        // Forces of a bench whose radii are not known are in proportion to its pretension, and so are the
        // tensions at which something happens.
        if (number.kind == OpenNumber::Kind::shape && number.unit == "N" && recording.nominal_is_fitted) {
            const double scale = usual_pretension_N(recording) / number.typical;
            for (double* force : {&number.typical, &number.low, &number.high}) *force *= scale;
        }
        cause.numbers.push_back(number);
        open.push_back(k);
    }
    cause.apply = [apply = effect.apply, values, open](BenchNumbers& numbers, Values fitted) {
        std::vector<double> all = values;
        for (std::size_t k = 0; k < open.size(); ++k) all[open[k]] = fitted[k];
        apply(numbers.effects, all);
    };
    cause.friction_std = std::max(nominal_log_std, effect.friction_log_std);
    cause.stiffness_std = std::max(nominal_log_std, effect.stiffness_log_std);
    return cause;
}

// What a channel's values show of its sensor.
struct Readings {
    double span = 0.0;
    double largest = 0.0;           // either way, apart from noise
    std::optional<double> lattice;  // the step on which all values lie, where that shows
};

Readings readings_of(const Recording& recording, std::size_t channel) {
    // Of a thousand samples with normal noise one reads this much more.
    constexpr double noise_beyond = 3.0;
    const ValueRange range = range_of(recording, channel);
    const double largest = std::max(std::abs(range.low), std::abs(range.high));
    return {largest_span(recording, channel),
            largest - noise_beyond * recording.channels[channel].noise_std.value_or(0.0),
            unstated_step(recording, channel)};
}

// Faults of one channel's sensor. Without a lattice its readings are not coarse. One that clips does so at
// its largest reading.
std::vector<CandidateCause> sensor_causes(const Channel& described, const Readings& readings,
                                          double time_step_s) {
    const std::string& channel = described.name;
    const double span = readings.span;
    const std::optional<double>& lattice = readings.lattice;
    const auto kind_of_fault = [](SensorFault::Size size) {
        switch (size) {
            case SensorFault::Size::either_sign:
                return OpenNumber::Kind::signed_size;
            case SensorFault::Size::lattice:
            case SensorFault::Size::limit:
                return OpenNumber::Kind::step;
            case SensorFault::Size::positive:
                break;
        }
        return OpenNumber::Kind::size;
    };
    const auto unit_of_typical = [&](SensorFault::TypicalOf what) {
        switch (what) {
            case SensorFault::TypicalOf::channel_span:
                return span;
            case SensorFault::TypicalOf::time_step:
                return time_step_s;
            case SensorFault::TypicalOf::absolute:
                break;
        }
        return 1.0;
    };
    std::vector<CandidateCause> causes;
    for (const SensorFault& fault : sensor_fault_catalogue()) {
        if (fault.size == SensorFault::Size::lattice && !lattice) continue;
        const bool is_drift = fault.value == &SensorFaults::drift_by_100_s;
        const bool is_limit = fault.size == SensorFault::Size::limit;
        // An encoder counts, and counts on.
        if ((is_drift || is_limit) && described.unit == "rad") continue;
        if (is_limit && readings.largest <= 0.0) continue;
        CandidateCause cause = plain(fault.name, "sensor:" + channel);
        cause.variant = fault.variant_at(channel);
        cause.is_exact = cause.is_exact && !is_drift;
        cause.is_of_runs = is_drift;
        cause.is_rare = is_drift;
        cause.is_sought_last = is_drift || is_limit;
        const bool is_in_channel_unit = fault.typical_of == SensorFault::TypicalOf::channel_span;
        cause.numbers = {{fault.number, is_in_channel_unit ? described.unit : fault.unit,
                          kind_of_fault(fault.size), fault.typical * unit_of_typical(fault.typical_of),
                          SensorFaults().*fault.value, -1e3, 1e3}};
        if (lattice && fault.size == SensorFault::Size::lattice) {
            cause.numbers.front().low = cause.numbers.front().high = *lattice;
            cause.is_seen = true;
        }
        if (is_limit) {
            OpenNumber& limit = cause.numbers.front();
            limit.typical = limit.low = limit.high = readings.largest;
        }
        const SensorFault::Shape& shape = fault.shape;
        if (shape.value != nullptr)
            cause.numbers.push_back({shape.name, "", OpenNumber::Kind::shape, SensorFaults().*shape.value,
                                     SensorFaults().*shape.value, shape.low, shape.high});
        cause.apply = [channel, size = fault.value, form = shape.value](BenchNumbers& numbers,
                                                                        Values values) {
            SensorFaults& faults = numbers.sensor_faults[channel];
            faults.*size = values[0];
            if (form != nullptr) faults.*form = values[1];
        };
        causes.push_back(cause);
    }
    return causes;
}

// The different values of a condition over the runs, in order.
std::vector<double> values_of(const Recording& recording, const std::string& condition) {
    std::vector<double> values;
    for (const RecordedRun& run : recording.runs) {
        const auto stated = run.conditions.find(condition);
        if (stated != run.conditions.end()) values.push_back(stated->second);
    }
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    return values;
}

CandidateCause following(const CandidateCause& number, const BenchNumbers::Following& follows, bool curved,
                         const std::string& unit, double typical) {
    CandidateCause cause = number;
    cause.variant += (cause.variant.empty() ? "with " : " with ") + follows.condition;
    cause.varies = follows.condition;
    cause.is_of_runs = true;
    const auto add = [&](const char* name) {
        cause.numbers.push_back(
            {name, unit, OpenNumber::Kind::signed_size, typical, 0.0, -100.0 * typical, 100.0 * typical});
    };
    add("change_over_half_range");
    if (curved) add("squared_change_over_half_range");
    cause.apply = [follows, curved](BenchNumbers& numbers, Values values) {
        numbers.follows.push_back(follows);
        numbers.follows.back().linear = values[0];
        if (curved) numbers.follows.back().squared = values[1];
    };
    return cause;
}

// A cause whose number is different in each run: a cable that was tensioned anew, a conduit that was laid
// anew, a sensor that was zeroed anew. The change is counted from the first run.
CandidateCause differing(const CandidateCause& number, BenchNumbers::Following differs,
                         const std::vector<RecordedRun>& runs, const std::string& unit, double typical) {
    CandidateCause cause = number;
    cause.variant += cause.variant.empty() ? "between runs" : " between runs";
    cause.is_of_runs = cause.is_rare = cause.is_sought_last = true;
    std::vector<int> changed;
    for (const RecordedRun& run : runs) {
        differs.of_runs[run.number] = 0.0;
        if (&run == &runs.front()) continue;
        changed.push_back(run.number);
        cause.numbers.push_back({"change_in_run_" + std::to_string(run.number), unit,
                                 OpenNumber::Kind::signed_size, typical, 0.0, -100.0 * typical,
                                 100.0 * typical});
    }
    cause.apply = [differs, changed](BenchNumbers& numbers, Values values) {
        numbers.follows.push_back(differs);
        for (std::size_t k = 0; k < changed.size(); ++k)
            numbers.follows.back().of_runs[changed[k]] = values[k];
    };
    return cause;
}

// Friction, pretension or the zero of a sensor that follows a condition with different values in the runs: in
// proportion to it, and with three values also curved, as the friction of a joint that bends either way.
// Where no condition tells the runs apart, they may differ all the same.
std::vector<CandidateCause> causes_of_runs(const Recording& recording) {
    constexpr double typical_log = 0.1;
    constexpr double typical_zero = 0.05;  // of the channel's span
    using What = BenchNumbers::Following::What;
    std::vector<CandidateCause> causes;
    const auto add_each_number = [&](BenchNumbers::Following follows, const auto& made_from) {
        follows.what = What::friction;
        causes.push_back(made_from(plain("param_mu", "parameter"), follows, "", typical_log));
        follows.what = What::pretension;
        causes.push_back(made_from(plain("param_T0", "parameter"), follows, "", typical_log));
        follows.what = What::zero;
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
            const Channel& described = recording.channels[channel];
            if (described.unit == "rad" || !recording.is_predicted(described.name)) continue;
            CandidateCause zero = plain("sensor_offset", "sensor:" + described.name);
            zero.family = "sensor";
            zero.variant = follows.channel = described.name;
            causes.push_back(
                made_from(zero, follows, described.unit, typical_zero * largest_span(recording, channel)));
        }
    };
    for (const auto& [condition, first] : recording.runs.front().conditions) {
        const std::vector<double> values = values_of(recording, condition);
        if (values.size() < 2) continue;
        BenchNumbers::Following follows;
        follows.condition = condition;
        follows.middle = 0.5 * (values.front() + values.back());
        follows.half_range = 0.5 * (values.back() - values.front());
        add_each_number(follows, [&](const CandidateCause& number, const BenchNumbers::Following& its,
                                     const std::string& unit, double typical) {
            return following(number, its, values.size() > 2, unit, typical);
        });
    }
    if (!causes.empty() || recording.runs.size() < 2) return causes;
    add_each_number(
        {}, [&](const CandidateCause& number, const BenchNumbers::Following& its, const std::string& unit,
                double typical) { return differing(number, its, recording.runs, unit, typical); });
    // A pretension that is not stated is sought as one of all runs.
    if (!recording.nominal_is_fitted && recording.nominal->spread.pretension > 0.0)
        std::erase_if(causes, [](const CandidateCause& cause) { return cause.effect == "param_T0"; });
    return causes;
}

}  // namespace

std::string in_words(const std::vector<const CandidateCause*>& causes) {
    std::string words;
    for (const CandidateCause* cause : causes) {
        words += (words.empty() ? "" : " with ") + cause_title(cause->effect);
        if (!cause->variant.empty()) words += " (" + channel_words(cause->variant) + ")";
    }
    return words;
}

bool is_slowness_of_one_sensor(const std::string& effect, const std::string& variant,
                               const CandidateCause& cause) {
    const auto is_slowness = [](const std::string& each) {
        return each == "sensor_lag" || each == "time_misalignment";
    };
    return is_slowness(effect) && is_slowness(cause.effect) && variant == cause.variant;
}

std::vector<CandidateCause> candidate_causes(const Recording& recording) {
    const double length_m = capstan::length_m(recording.nominal->curvature);

    std::vector<CandidateCause> causes = {plain("none", "none")};
    CandidateCause friction = plain("param_mu", "parameter");
    friction.friction_std = wrong_log_std;
    CandidateCause stiffness = plain("param_K", "parameter");
    stiffness.stiffness_std = wrong_log_std;
    CandidateCause pretension = plain("param_T0", "parameter");
    pretension.pretension_std = wrong_log_std;
    causes.insert(causes.end(), {friction, stiffness, pretension});
    for (const Effect& effect : effect_catalogue()) {
        if (effect.needs_pair && recording.mode == BenchMode::single_cable) continue;
        CandidateCause cause = cause_of(effect, recording, length_m);
        if (effect.name == "backlash") cause.numbers.front().low = unseen_half_gap_rad(recording, effect.end);
        causes.push_back(std::move(cause));
    }
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        const std::string& name = recording.channels[channel].name;
        // The load angle of a described bench has an encoder; what watches that of a drive may be slow.
        if (!recording.is_predicted(name) || (name == channel::load_angle && !recording.nominal_is_fitted))
            continue;
        for (CandidateCause& cause :
             sensor_causes(recording.channels[channel], readings_of(recording, channel),
                           1.0 / recording.sample_rate_Hz))
            causes.push_back(std::move(cause));
    }
    for (CandidateCause& cause : causes_of_runs(recording)) causes.push_back(std::move(cause));
    std::stable_partition(causes.begin(), causes.end(),
                          [](const CandidateCause& cause) { return !cause.is_sought_last; });
    return causes;
}

}  // namespace capstan::gap
