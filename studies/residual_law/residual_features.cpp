#include "capstan/residual_law/residual_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "capstan/cable/invalid_input.h"
#include "capstan/simple_models/stop_operator.h"

namespace capstan::residual_law {

namespace {

constexpr std::array<std::pair<FeatureKind, const char*>, 9> feature_names = {
    {{FeatureKind::constant, "constant"},
     {FeatureKind::position, "position"},
     {FeatureKind::wave_sine, "wave_sine"},
     {FeatureKind::wave_cosine, "wave_cosine"},
     {FeatureKind::speed, "speed"},
     {FeatureKind::speed_magnitude, "speed_magnitude"},
     {FeatureKind::friction, "friction"},
     {FeatureKind::relaxation, "relaxation"},
     {FeatureKind::session_time, "session_time"}}};

// A position or speed beyond what was recorded is taken for this much of the largest recorded one, so that no
// term grows where nothing was fitted.
constexpr double max_recorded = 1.25;
// Speeds are slopes over this time: one encoder step a sample is not a speed.
constexpr double slope_s = 0.04;
// The direction of motion has changed when the motion has come back by this part of its half range.
constexpr double reversal_fraction = 0.02;

double largest_magnitude(const std::vector<double>& values) {
    double largest = 0.0;
    for (const double value : values) largest = std::max(largest, std::abs(value));
    return largest;
}

// The slope of the motion, per second.
std::vector<double> speeds(const ResidualRun& run) {
    const auto samples = static_cast<std::ptrdiff_t>(run.motion.size());
    const auto reach = std::max<std::ptrdiff_t>(1, std::lround(slope_s / run.sample_period_s));
    std::vector<double> slopes(run.motion.size(), 0.0);
    for (std::ptrdiff_t k = 0; k < samples; ++k) {
        const std::ptrdiff_t before = std::max<std::ptrdiff_t>(0, k - reach);
        const std::ptrdiff_t after = std::min(samples - 1, k + reach);
        if (after > before)
            slopes[static_cast<std::size_t>(k)] =
                (run.motion[static_cast<std::size_t>(after)] - run.motion[static_cast<std::size_t>(before)]) /
                (static_cast<double>(after - before) * run.sample_period_s);
    }
    return slopes;
}

Eigen::VectorXd relaxation(const ResidualRun& run, double limit, double time_constant_s) {
    const Eigen::VectorXd held = simple_models::stop_operator(run.motion, limit);
    Eigen::VectorXd fading(held.size());
    double direction = 0.0;
    double since_s = 0.0;
    for (Eigen::Index k = 0; k < held.size(); ++k) {
        const double now = held[k] >= 1.0 ? 1.0 : held[k] <= -1.0 ? -1.0 : direction;
        since_s = now == direction ? since_s + run.sample_period_s : 0.0;
        direction = now;
        fading[k] = direction * std::exp(-since_s / time_constant_s);
    }
    return fading;
}

Eigen::VectorXd without_load(const Feature& feature, const FeatureScales& scales, const ResidualRun& run) {
    const auto samples = static_cast<Eigen::Index>(run.motion.size());
    const Eigen::Map<const Eigen::ArrayXd> motion(run.motion.data(), samples);
    switch (feature.kind) {
        case FeatureKind::constant:
            return Eigen::VectorXd::Ones(samples);
        case FeatureKind::position:
            return ((motion - scales.motion_middle) / scales.motion_half_range)
                .max(-max_recorded)
                .min(max_recorded)
                .pow(feature.parameter);
        case FeatureKind::wave_sine:
            return (2.0 * std::numbers::pi / feature.parameter * motion).sin();
        case FeatureKind::wave_cosine:
            return (2.0 * std::numbers::pi / feature.parameter * motion).cos();
        case FeatureKind::speed:
        case FeatureKind::speed_magnitude: {
            const std::vector<double> slopes = speeds(run);
            const Eigen::Map<const Eigen::ArrayXd> slope(slopes.data(), samples);
            const Eigen::ArrayXd bounded = (slope / scales.speed).max(-max_recorded).min(max_recorded);
            return feature.kind == FeatureKind::speed ? bounded : Eigen::ArrayXd(bounded.abs());
        }
        case FeatureKind::friction:
            return simple_models::stop_operator(run.motion, feature.parameter);
        case FeatureKind::relaxation:
            return relaxation(run, reversal_fraction * scales.motion_half_range, feature.parameter);
        case FeatureKind::session_time:
            return (run.session_start_s +
                    Eigen::ArrayXd::LinSpaced(samples, 0.0, static_cast<double>(samples - 1)) *
                        run.sample_period_s) /
                   scales.session_s;
    }
    return {};
}

}  // namespace

std::string name_of(FeatureKind kind) {
    for (const auto& [each, name] : feature_names)
        if (each == kind) return name;
    return {};
}

FeatureKind feature_kind_of(const std::string& name) {
    for (const auto& [kind, each] : feature_names)
        if (each == name) return kind;
    throw InvalidInput({"'" + name + "' is not a feature of a residual law"});
}

FeatureScales scales_of(const std::vector<ResidualRun>& runs) {
    FeatureScales scales;
    double low = 0.0;
    double high = 0.0;
    double speed = 0.0;
    double session_s = 0.0;
    bool is_first = true;
    for (const ResidualRun& run : runs) {
        const auto [lowest, highest] = std::minmax_element(run.motion.begin(), run.motion.end());
        low = is_first ? *lowest : std::min(low, *lowest);
        high = is_first ? *highest : std::max(high, *highest);
        is_first = false;
        speed = std::max(speed, largest_magnitude(speeds(run)));
        for (const double load : run.load)
            if (std::abs(load) > std::abs(scales.load)) scales.load = load;
        session_s = std::max(
            session_s, run.session_start_s + static_cast<double>(run.motion.size()) * run.sample_period_s);
    }
    scales.motion_middle = 0.5 * (low + high);
    if (high > low) scales.motion_half_range = 0.5 * (high - low);
    if (speed > 0.0) scales.speed = speed;
    const bool is_stated = std::any_of(runs.begin(), runs.end(), [&](const ResidualRun& run) {
        return run.session_start_s != runs.front().session_start_s;
    });
    if (is_stated || runs.size() == 1) scales.session_s = session_s;
    return scales;
}

Eigen::VectorXd column_of(const Feature& feature, const FeatureScales& scales, const ResidualRun& run) {
    Eigen::VectorXd column = without_load(feature, scales, run);
    if (feature.times_load)
        column.array() *= Eigen::Map<const Eigen::ArrayXd>(run.load.data(), column.size()) / scales.load;
    return column;
}

std::vector<Term> possible_terms(const FeatureScales& scales) {
    constexpr int powers = 3;
    constexpr int periods = 24;  // from the range down to a sixteenth of it
    constexpr double period_ratio = 1.128;
    constexpr std::array time_constants_s = {0.3, 1.0, 3.0};
    const double range = 2.0 * scales.motion_half_range;
    std::vector<Term> terms;
    for (const bool times_load : {false, true}) {
        if (times_load && scales.load == 0.0) continue;
        terms.push_back({{FeatureKind::constant, 0.0, times_load}});
        for (int power = 1; power <= powers; ++power)
            terms.push_back({{FeatureKind::position, static_cast<double>(power), times_load}});
        for (int k = 0; k < periods; ++k) {
            const double period = range / std::pow(period_ratio, k);
            terms.push_back({{FeatureKind::wave_sine, period, times_load},
                             {FeatureKind::wave_cosine, period, times_load}});
        }
        terms.push_back({{FeatureKind::speed, 0.0, times_load}});
        terms.push_back({{FeatureKind::speed_magnitude, 0.0, times_load}});
        for (const double threshold : simple_models::stop_thresholds)
            terms.push_back({{FeatureKind::friction, threshold * range, times_load}});
        for (const double time_constant_s : time_constants_s)
            terms.push_back({{FeatureKind::relaxation, time_constant_s, times_load}});
    }
    if (scales.session_s > 0.0) terms.push_back({{FeatureKind::session_time, 0.0, false}});
    return terms;
}

std::vector<Term> terms_that_belong_together(const FeatureScales& scales) {
    std::vector<Term> all;
    for (const double threshold : simple_models::stop_thresholds) {
        Term together;
        for (const bool times_load : {false, true}) {
            if (times_load && scales.load == 0.0) continue;
            together.push_back({FeatureKind::constant, 0.0, times_load});
            together.push_back(
                {FeatureKind::friction, threshold * 2.0 * scales.motion_half_range, times_load});
        }
        all.push_back(std::move(together));
    }
    return all;
}

std::vector<Feature> history_features(const FeatureScales& scales) {
    const double range = 2.0 * scales.motion_half_range;
    std::vector<Feature> features = {{FeatureKind::constant, 0.0, false},
                                     {FeatureKind::position, 1.0, false}};
    if (scales.load != 0.0) features.push_back({FeatureKind::constant, 0.0, true});
    for (const double threshold : simple_models::stop_thresholds) {
        features.push_back({FeatureKind::friction, threshold * range, false});
        if (scales.load != 0.0) features.push_back({FeatureKind::friction, threshold * range, true});
    }
    return features;
}

}  // namespace capstan::residual_law
