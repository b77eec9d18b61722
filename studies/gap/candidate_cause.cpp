#include "capstan/gap/candidate_cause.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "capstan/effects/effect_catalogue.h"

namespace capstan::gap {

namespace {

using Values = std::span<const double>;

// Wide enough to hold any wrong parameter that a laboratory would not notice otherwise.
constexpr double wrong_log_std = 0.5;
// Of the friction coefficient at a reference load that nobody measured.
constexpr double loose_log_std = 0.1;

CandidateCause plain(const std::string& effect, const std::string& family, const std::string& component) {
    CandidateCause cause;
    cause.effect = effect;
    cause.family = family;
    cause.component = component;
    cause.apply = [](BenchNumbers&, Values) {};
    cause.friction_std = cause.stiffness_std = cause.pretension_std = nominal_log_std;
    return cause;
}

OpenNumber::Kind kind_of(const EffectParameter& parameter, double absent) {
    if (parameter.name == "middle") return OpenNumber::Kind::place;
    if (parameter.name == "periods_per_turn") return OpenNumber::Kind::periods;
    if (parameter.typical == absent || (absent != 0.0 && absent != 1.0)) return OpenNumber::Kind::shape;
    return parameter.low < absent ? OpenNumber::Kind::signed_size : OpenNumber::Kind::size;
}

// Normal force per length where the cable bends, at the runs' mean pretension: about where a bench works.
double usual_normal_force_N_per_m(const Recording& recording) {
    double pretension_N = 0.0;
    for (const RecordedRun& run : recording.runs)
        pretension_N += run.pretension_N.value_or(0.0) / static_cast<double>(recording.runs.size());
    double radius_m = straight;
    for (const CurvaturePiece& piece : recording.nominal->curvature)
        radius_m = std::min(radius_m, piece.bend_radius_m);
    return pretension_N / radius_m;
}

// A power law's reference and its factor say the same; the factor is friction's own, so the reference is
// given.
CandidateCause load_dependent_friction(CandidateCause cause, double reference_N_per_m) {
    cause.numbers.resize(1);
    cause.given = {{"reference", "N/m", reference_N_per_m}};
    cause.apply = [reference_N_per_m](BenchNumbers& numbers, Values values) {
        numbers.effects.load_dependent_friction = {values[0], reference_N_per_m};
    };
    cause.friction_std = loose_log_std;
    return cause;
}

CandidateCause cause_of(const Effect& effect, double length_m) {
    CandidateCause cause = plain(effect.name, effect.family, effect.component);
    cause.variant = effect.variant;
    cause.end = effect.end;
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
        const EffectParameter& parameter = effect.parameters[k];
        OpenNumber number{parameter.name,    parameter.unit,   kind_of(parameter, effect.absent[k]),
                          parameter.typical, effect.absent[k], parameter.low,
                          parameter.high};
        if (number.kind == OpenNumber::Kind::place) number.typical = length_m;
        cause.numbers.push_back(number);
    }
    cause.apply = [apply = effect.apply](BenchNumbers& numbers, Values values) {
        apply(numbers.effects, values);
    };
    return cause;
}

// Faults of one channel's sensor; sizes in parts of what the channel spans.
// `lattice`: the step on which all its values lie, where that shows.
std::vector<CandidateCause> sensor_causes(const std::string& channel, double span, double time_step_s,
                                          const std::optional<double>& lattice) {
    using Setter = void (*)(SensorFaults&, double);
    struct Fault {
        const char* name;
        const char* unit;
        OpenNumber::Kind kind;
        double typical;
        double absent;
        Setter set;
    };
    const Fault faults[] = {
        {"sensor_gain", "", OpenNumber::Kind::signed_size, 1.1, 1.0,
         [](SensorFaults& f, double v) { f.gain = v; }},
        {"sensor_offset", "", OpenNumber::Kind::signed_size, 0.05 * span, 0.0,
         [](SensorFaults& f, double v) { f.offset = v; }},
        {"sensor_lag", "s", OpenNumber::Kind::size, 0.03, 0.0,
         [](SensorFaults& f, double v) { f.lag_s = v; }},
        {"time_misalignment", "s", OpenNumber::Kind::signed_size, 3.0 * time_step_s, 0.0,
         [](SensorFaults& f, double v) { f.delay_s = v; }},
        {"sensor_quantization", "", OpenNumber::Kind::step, 0.05 * span, 0.0,
         [](SensorFaults& f, double v) { f.step = v; }},
        {"sensor_hysteresis", "", OpenNumber::Kind::size, 0.03 * span, 0.0,
         [](SensorFaults& f, double v) { f.hysteresis = v; }},
    };
    std::vector<CandidateCause> causes;
    for (const Fault& fault : faults) {
        CandidateCause cause = plain(fault.name, "sensor", "sensor:" + channel);
        cause.variant = channel;
        cause.numbers = {{"size", fault.unit, fault.kind, fault.typical, fault.absent, -1e3, 1e3}};
        if (fault.kind == OpenNumber::Kind::step && lattice) {
            cause.numbers.front().low = cause.numbers.front().high = *lattice;
        }
        cause.apply = [channel, set = fault.set](BenchNumbers& numbers, Values values) {
            set(numbers.sensor_faults[channel], values[0]);
        };
        causes.push_back(cause);
    }
    return causes;
}

bool ever_predicted(const Recording& recording, const std::string& channel) {
    return std::any_of(recording.runs.begin(), recording.runs.end(),
                       [&](const RecordedRun& run) { return !run.drives(channel); });
}

double span_of(const Recording& recording, std::size_t channel) {
    double span = 0.0;
    for (const RecordedRun& run : recording.runs) {
        const auto [low, high] = std::minmax_element(run.values[channel].begin(), run.values[channel].end());
        span = std::max(span, *high - *low);
    }
    return span;
}

}  // namespace

std::optional<double> unstated_step(const Recording& recording, std::size_t channel) {
    constexpr double tolerance = 0.02;  // of a step, for what the file rounds
    constexpr std::size_t samples_per_value = 10;
    std::vector<double> values;
    for (const RecordedRun& run : recording.runs)
        values.insert(values.end(), run.values[channel].begin(), run.values[channel].end());
    const std::size_t samples = values.size();
    std::sort(values.begin(), values.end());
    const double rounding = 1e-9 * (values.back() - values.front());
    values.erase(
        std::unique(values.begin(), values.end(), [&](double a, double b) { return b - a <= rounding; }),
        values.end());
    if (values.size() < 3 || values.size() * samples_per_value > samples) return {};
    double step = values.back() - values.front();
    for (std::size_t k = 1; k < values.size(); ++k) step = std::min(step, values[k] - values[k - 1]);
    step = (values.back() - values.front()) / std::round((values.back() - values.front()) / step);
    const Channel& described = recording.channels[channel];
    if (step < 1.5 * std::max(described.step.value_or(0.0), described.noise_std.value_or(0.0))) return {};
    for (const double value : values) {
        const double off = (value - values.front()) / step;
        if (std::abs(off - std::round(off)) > tolerance) return {};
    }
    return step;
}

double OpenNumber::value(double coordinate) const {
    double value = 0.0;
    switch (kind) {
        case Kind::size:
        case Kind::step:
            value = absent + std::max(0.0, coordinate) * (typical - absent);
            break;
        case Kind::signed_size:
            value = absent + coordinate * (typical - absent);
            break;
        case Kind::shape:
            value = typical * std::exp(coordinate);
            break;
        case Kind::periods:
            value = std::round(coordinate);
            break;
        case Kind::place:
            value = typical * coordinate;
            break;
    }
    return std::clamp(value, low, high);
}

double OpenNumber::prior_mean() const {
    return kind == Kind::place ? 0.5 : 0.0;
}

double OpenNumber::prior_std() const {
    switch (kind) {
        case Kind::size:
        case Kind::signed_size:
        case Kind::step:
            return 30.0;
        case Kind::periods:
            return 1e3;
        case Kind::shape:
        case Kind::place:
            return 1.0;
    }
    return 1.0;
}

std::vector<double> OpenNumber::starts() const {
    switch (kind) {
        case Kind::size:
            return {0.5, 3.0};
        case Kind::signed_size:
            return {-1.0, 1.0};
        case Kind::shape:
            return {0.0};
        case Kind::periods: {
            constexpr int max_periods = 36;
            std::vector<double> starts;
            for (int periods = 1; periods <= max_periods; ++periods) starts.push_back(periods);
            return starts;
        }
        case Kind::step: {
            if (low == high) return {1.0};
            std::vector<double> starts{0.1};
            while (starts.back() * 1.05 < 10.0) starts.push_back(starts.back() * 1.05);
            return starts;
        }
        case Kind::place:
            return {0.1, 0.3, 0.5, 0.7, 0.9};
    }
    return {0.0};
}

std::vector<CandidateCause> candidate_causes(const Recording& recording) {
    double length_m = 0.0;
    for (const CurvaturePiece& piece : recording.nominal->curvature) length_m += piece.length_m;

    std::vector<CandidateCause> causes = {plain("none", "none", "none")};
    CandidateCause friction = plain("param_mu", "friction place", "parameter");
    friction.friction_std = wrong_log_std;
    CandidateCause stiffness = plain("param_K", "compliance", "parameter");
    stiffness.stiffness_std = wrong_log_std;
    CandidateCause pretension = plain("param_T0", "pretension", "parameter");
    pretension.pretension_std = wrong_log_std;
    causes.insert(causes.end(), {friction, stiffness, pretension});
    for (const Effect& effect : effect_catalogue()) {
        const bool needs_a_pair = effect.name == "moving_bend" || effect.variant == "cable B" ||
                                  effect.variant == "cable A" || effect.end == "load";
        if (recording.mode == BenchMode::single_cable && needs_a_pair && effect.name != "conduit_compliance")
            continue;
        CandidateCause cause = cause_of(effect, length_m);
        // Nobody knows at which tension the stated stiffness of a cable that stiffens was measured.
        if (effect.name == "cable_stiffness_nonlinear") cause.stiffness_std = wrong_log_std;
        causes.push_back(effect.name == "load_dependent_friction"
                             ? load_dependent_friction(cause, usual_normal_force_N_per_m(recording))
                             : cause);
    }
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        const std::string& name = recording.channels[channel].name;
        if (!ever_predicted(recording, name) || name == "load_angle") continue;
        for (CandidateCause& cause :
             sensor_causes(name, span_of(recording, channel), 1.0 / recording.sample_rate_Hz,
                           unstated_step(recording, channel)))
            causes.push_back(std::move(cause));
    }
    return causes;
}

}  // namespace capstan::gap
