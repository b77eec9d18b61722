#include "capstan/gap/bench_knowledge.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

#include "capstan/platform/statistics.h"
#include "capstan/recording/channel_range.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

// Wherever a search goes, the bench can still be built: a factor of twelve, or 2.5 deviations of a number of
// which next to nothing is stated. Downwards a factor of fifty, because a pretension may be as good as none.
double bounded_log(double logarithm, double prior_std) {
    const double wide = 2.5 * prior_std;
    return std::clamp(logarithm, -std::max(4.0, wide), std::max(2.5, wide));
}

FloatingNumber ratio(const std::string& name, double prior_std, const std::string& effect,
                     double BenchNumbers::*number) {
    return {.name = name,
            .prior_std = prior_std,
            .effect = effect,
            .component = "parameter",
            .apply = [number](BenchNumbers& bench, double value) { bench.*number = value; }};
}

// The three numbers with these uncertainties where the sidecar states values, and with its own where it
// states ranges or nothing. Only a stated value can be a wrong one.
std::vector<FloatingNumber> ratios(const NominalSpread& of_values, const NominalSpread& stated) {
    const auto number = [](const char* name, const char* wrong, double of_value, double spread,
                           double BenchNumbers::*in_bench) {
        if (spread > 0.0) return ratio(name, spread, "", in_bench);
        FloatingNumber stated_number = ratio(name, of_value, wrong, in_bench);
        stated_number.measured_std = nominal_log_std;
        return stated_number;
    };
    return {
        number("friction", "param_mu", of_values.friction, stated.friction, &BenchNumbers::friction_ratio),
        number("stiffness", "param_K", of_values.stiffness, stated.stiffness, &BenchNumbers::stiffness_ratio),
        number("pretension", "param_T0", of_values.pretension, stated.pretension,
               &BenchNumbers::pretension_ratio)};
}

// Half of what a channel covers over all runs; of a force or torque from no load on, for that is what its
// sensor is made for and what a bearing carries, however little a load varies. Nobody knows what the sensors
// of a drive without a description are made for.
double half_span(const Recording& recording, std::size_t channel) {
    const ValueRange range = range_of(recording, channel);
    if (recording.channels[channel].unit == "rad" || recording.nominal->is_equivalent)
        return 0.5 * range.span();
    return 0.5 * (std::max(range.high, 0.0) - std::min(range.low, 0.0));
}

// A sensor's zero as a part of that, bearings' friction as a part of the torque at their end.
void add_zeros_and_bearings(const Recording& recording, double zero_part, double bearing_part,
                            BenchKnowledge& bench) {
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        const std::string& name = recording.channels[channel].name;
        const std::string& unit = recording.channels[channel].unit;
        const bool predicted = recording.is_predicted(name);
        // The zero of a drive's angle is fitted with its other numbers. Where an angle drives the bench, its
        // zero turns both ends alike.
        if (unit == "rad" && (recording.nominal_is_fitted || !predicted)) continue;
        if (!predicted && name != channel::motor_torque && name != channel::load_torque) continue;
        bench.numbers.push_back({.name = "zero of " + name,
                                 .unit = unit,
                                 .kind = FloatingNumber::Kind::zero,
                                 .scale = half_span(recording, channel),
                                 .prior_std = zero_part,
                                 .of_a_sensor = predicted,
                                 .effect = "sensor_offset",
                                 .variant = name,
                                 .component = "sensor:" + name,
                                 .apply = [name](BenchNumbers& numbers, double value) {
                                     numbers.sensor_faults[name].offset = value;
                                 }});
    }
    // An encoder's count is latched when it is read. A force passes an amplifier, whose filter delays it by a
    // part of a sample.
    constexpr double time_of_an_encoder = 0.1;  // samples
    constexpr double time_of_a_force = 0.5;
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        const std::string& name = recording.channels[channel].name;
        if (!recording.is_predicted(name)) continue;
        const double agreement =
            recording.channels[channel].unit == "rad" ? time_of_an_encoder : time_of_a_force;
        bench.numbers.push_back({.name = "time of " + name,
                                 .unit = "s",
                                 .kind = FloatingNumber::Kind::zero,
                                 .scale = 1.0 / recording.sample_rate_Hz,
                                 .prior_std = agreement,
                                 .of_a_sensor = true,
                                 .usual = 2.0 * agreement,
                                 .effect = "time_misalignment",
                                 .variant = name,
                                 .component = "sensor:" + name,
                                 .apply = [name](BenchNumbers& numbers, double value) {
                                     numbers.sensor_faults[name].delay_s += value;
                                 }});
    }
    const auto add_bearing = [&](double half_span_Nm, const char* name, const char* component,
                                 const char* end, BearingFriction PulleyFriction::*at) {
        if (half_span_Nm == 0.0) return;
        bench.numbers.push_back({.name = name,
                                 .unit = "N m",
                                 .kind = FloatingNumber::Kind::size,
                                 .scale = half_span_Nm,
                                 .prior_std = bearing_part,
                                 .effect = "pulley_friction",
                                 .variant = end,
                                 .component = component,
                                 .end = end,
                                 .apply = [at](BenchNumbers& numbers, double value) {
                                     (numbers.effects.of<PulleyFriction>().*at).coulomb_Nm = value;
                                 }});
    };
    const auto half_span_of = [&](const char* name) {
        const auto channel = recording.channel(name);
        return channel ? half_span(recording, static_cast<std::size_t>(*channel)) : 0.0;
    };
    add_bearing(half_span_of(channel::motor_torque), "friction of the motor's bearing", "motor", "motor",
                &PulleyFriction::motor);
    const double compliance = recording.nominal->load_compliance_rad_per_Nm;
    if (recording.mode == BenchMode::pull_pull)
        add_bearing(compliance > 0.0 ? half_span_of(channel::load_angle) / compliance
                                     : half_span_of(channel::load_torque),
                    "friction of the load's bearing", "load_pulley", "load", &PulleyFriction::load);
}

// The friction of a bearing builds up while its balls, seal and gears wind up: over a hundredth of a degree
// in a plain bearing, over a degree behind a gear.
FloatingNumber presliding_of_bearings() {
    constexpr double usual_rad = 2e-3;
    constexpr double by_a_factor_of_three = 1.2;
    return {.name = "presliding of the bearings",
            .prior_std = by_a_factor_of_three,
            .apply = [](BenchNumbers& numbers, double value) {
                PulleyFriction& bearings = numbers.effects.of<PulleyFriction>();
                bearings.motor.presliding_rad = bearings.load.presliding_rad = usual_rad * value;
            }};
}

// A conduit of unknown routing has its bends anywhere: a part of it may be bent e times as much as another.
void add_bends(BenchKnowledge& bench) {
    const auto number = [](const char* name, double BenchNumbers::*in_bench) -> FloatingNumber {
        return {.name = name, .prior_std = 1.0, .apply = [in_bench](BenchNumbers& numbers, double value) {
                    numbers.*in_bench = value;
                }};
    };
    bench.numbers.push_back(number("bends near the motor", &BenchNumbers::bend_at_motor_ratio));
    bench.numbers.push_back(number("bends near the load", &BenchNumbers::bend_at_load_ratio));
}

// Whether the torque on the load follows its angle, so that most of its variance is told by it.
bool is_held_by_a_spring(const Recording& recording) {
    constexpr double most = 0.8;
    const auto angle = recording.channel(channel::load_angle);
    const auto torque = recording.channel(channel::load_torque);
    if (!angle || !torque) return false;
    double angle_squares = 0.0;
    double torque_squares = 0.0;
    double products = 0.0;
    for (const RecordedRun& run : recording.runs) {
        const std::vector<double>& angle_rad = run.values[static_cast<std::size_t>(*angle)];
        const std::vector<double>& torque_Nm = run.values[static_cast<std::size_t>(*torque)];
        const double mean_rad = mean_of(angle_rad);
        const double mean_Nm = mean_of(torque_Nm);
        for (std::size_t sample = 0; sample < angle_rad.size(); ++sample) {
            angle_squares += std::pow(angle_rad[sample] - mean_rad, 2);
            torque_squares += std::pow(torque_Nm[sample] - mean_Nm, 2);
            products += (angle_rad[sample] - mean_rad) * (torque_Nm[sample] - mean_Nm);
        }
    }
    return products * products > most * angle_squares * torque_squares;
}

// The ratio of a drive's pulleys was read off its motion, which cables that stretch shorten by some percent.
// Where the load is a spring, they stretch most where the load turns most, so that only the torques tell a
// stiff cable and a larger pulley from a soft cable and a smaller one.
FloatingNumber radius_of_load_pulley(bool held_by_a_spring) {
    constexpr double by_a_tenth = 0.1;
    constexpr double by_some_percent = 0.02;
    return {.name = "radius of the load pulley",
            .prior_std = held_by_a_spring ? by_a_tenth : by_some_percent,
            .apply = [](BenchNumbers& numbers, double value) { numbers.load_radius_ratio = value; }};
}

// A force sensor's gain is good to some percent: its own class, how it is mounted, and how it was calibrated.
void add_gains(const Recording& recording, BenchKnowledge& bench) {
    constexpr double by_some_percent = 0.02;
    for (const auto& channel : recording.channels) {
        if (channel.unit == "rad" || !recording.is_predicted(channel.name)) continue;
        bench.numbers.push_back({.name = "gain of " + channel.name,
                                 .prior_std = by_some_percent,
                                 .of_a_sensor = true,
                                 .usual = 2.0 * by_some_percent,
                                 .effect = "sensor_gain",
                                 .variant = channel.name,
                                 .component = "sensor:" + channel.name,
                                 .apply = [name = channel.name](BenchNumbers& numbers, double value) {
                                     numbers.sensor_faults[name].gain *= value;
                                 }});
    }
}

// What holds the load where only its motion was recorded, and the constant of a motor whose current was.
void add_undescribed_parts(const NominalBench& nominal, double prior_std, BenchKnowledge& bench) {
    if (nominal.load_compliance_rad_per_Nm > 0.0)
        bench.numbers.push_back({.name = "compliance of what holds the load",
                                 .unit = "rad/(N m)",
                                 .scale = nominal.load_compliance_rad_per_Nm,
                                 .prior_std = prior_std,
                                 .apply = [](BenchNumbers& numbers, double value) {
                                     numbers.effects.of<EnvironmentCoupling>().compliance_rad_per_Nm = value;
                                 }});
    if (nominal.torque_constant_Nm_per_A > 0.0)
        bench.numbers.push_back(
            {.name = "torque constant",
             .unit = "N m/A",
             .scale = nominal.torque_constant_Nm_per_A,
             .prior_std = prior_std,
             .of_a_sensor = true,
             .apply = [assumed = nominal.torque_constant_Nm_per_A](BenchNumbers& numbers, double value) {
                 numbers.sensor_faults[channel::motor_torque].gain *= assumed / value;
             }});
}

// Sets of the three stated numbers, a bit for each.
constexpr int sets_of_numbers = 1 << nominal_coordinates;

bool is_in(int set, int number) {
    return ((set >> number) & 1) != 0;
}

// Half of all benches were measured; there one stated number of fifty is wrong, as any one cause is as
// probable. On the others any number may have been measured. One of which no value was stated is not
// measured.
double prior_probability(const BenchKnowledge& bench, int wrong) {
    constexpr double wrong_though_measured = 0.02;
    double if_measured = 1.0;
    double if_not = 1.0;
    for (int k = 0; k < nominal_coordinates; ++k) {
        if (bench.numbers[static_cast<std::size_t>(k)].measured_std == 0.0) {
            if (!is_in(wrong, k)) return 0.0;
            continue;
        }
        if_measured *= is_in(wrong, k) ? wrong_though_measured : 1.0 - wrong_though_measured;
        if_not *= 0.5;
    }
    return 0.5 * (if_measured + if_not);
}

// Of the numbers' logarithms before the recording, in units of the variances of their priors.
Eigen::Vector3d variance_where(const BenchKnowledge& bench, int wrong) {
    Eigen::Vector3d variance = Eigen::Vector3d::Ones();
    for (int k = 0; k < nominal_coordinates; ++k) {
        const FloatingNumber& number = bench.numbers[static_cast<std::size_t>(k)];
        if (!is_in(wrong, k)) variance[k] = std::pow(number.measured_std / number.prior_std, 2);
    }
    return variance;
}

// What a recording tells of the three numbers beside their priors, in units of these: A and b of E63.
struct Told {
    Eigen::Matrix3d information;
    Eigen::Vector3d shown;
};

// With that unit a covariance has eigenvalues of at most 1.
Told told_beside_priors(const BenchKnowledge& bench, const Eigen::Vector3d& coordinates,
                        const Eigen::Matrix3d& covariance) {
    constexpr double least = 1e-12;
    Eigen::Vector3d widths;
    for (int k = 0; k < nominal_coordinates; ++k)
        widths[k] = bench.numbers[static_cast<std::size_t>(k)].prior_std;
    const Eigen::Matrix3d per_width = widths.cwiseInverse().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(per_width * covariance * per_width);
    const Eigen::Vector3d inverse = solver.eigenvalues().cwiseMax(least).cwiseMin(1.0).cwiseInverse();
    const Eigen::Matrix3d& axes = solver.eigenvectors();
    const Eigen::Vector3d told = inverse - Eigen::Vector3d::Ones();
    return {axes * told.asDiagonal() * axes.transpose(),
            axes * inverse.asDiagonal() * axes.transpose() * per_width * coordinates};
}

// The logarithm, up to a constant, of the evidence of numbers with these variances beforehand.
double log_evidence(const Told& told, const Eigen::Vector3d& variance) {
    const Eigen::Vector3d deviations = variance.cwiseSqrt();
    const Eigen::LLT<Eigen::Matrix3d> factor(
        Eigen::Matrix3d::Identity() + deviations.asDiagonal() * told.information * deviations.asDiagonal());
    const Eigen::Vector3d shown = deviations.asDiagonal() * told.shown;
    return 0.5 * shown.dot(factor.solve(shown)) - factor.matrixLLT().diagonal().array().log().sum();
}

}  // namespace

double FloatingNumber::value(double coordinate) const {
    switch (kind) {
        case Kind::ratio:
            return scale * std::exp(bounded_log(coordinate, prior_std));
        case Kind::size:
            return scale * std::max(0.0, coordinate);
        case Kind::zero:
            return scale * coordinate;
    }
    return 0.0;
}

bool FloatingNumber::is_at_bound(double coordinate) const {
    return kind == Kind::ratio && bounded_log(coordinate, prior_std) != coordinate;
}

bool BenchKnowledge::has_unknown_number() const {
    constexpr double by_a_third = 0.3;
    return std::any_of(numbers.begin(), numbers.begin() + nominal_coordinates,
                       [](const FloatingNumber& number) { return number.prior_std > by_a_third; });
}

const BenchKnowledge& measured_bench() {
    static const BenchKnowledge bench = measured_bench(NominalSpread{});
    return bench;
}

BenchKnowledge measured_bench(const NominalSpread& stated) {
    return {ratios({nominal_log_std, nominal_log_std, nominal_log_std}, stated)};
}

BenchKnowledge built_bench(const Recording& recording) {
    constexpr NominalSpread of_values{.friction = 0.22, .stiffness = 0.10, .pretension = 0.15};
    // A load cell's zero is within 1 to 2% of its full scale, and a recording uses about a third of that.
    constexpr double zero_part = 0.1;
    constexpr double bearing_part = 0.03;
    BenchKnowledge bench{ratios(of_values, recording.nominal->spread)};
    add_zeros_and_bearings(recording, zero_part, bearing_part, bench);
    bench.numbers.push_back(presliding_of_bearings());
    add_gains(recording, bench);
    return bench;
}

StatedNumbers weigh_stated_numbers(const BenchKnowledge& bench, const Eigen::Vector3d& coordinates,
                                   const Eigen::Matrix3d& covariance) {
    const Told told = told_beside_priors(bench, coordinates, covariance);
    std::array<double, sets_of_numbers> log_weights{};
    for (int wrong = 0; wrong < sets_of_numbers; ++wrong)
        log_weights[static_cast<std::size_t>(wrong)] =
            std::log(prior_probability(bench, wrong)) + log_evidence(told, variance_where(bench, wrong));
    const double most = *std::max_element(log_weights.begin(), log_weights.end());
    StatedNumbers stated{.wrong = Eigen::Vector3d::Zero()};
    double sum = 0.0;
    for (int wrong = 0; wrong < sets_of_numbers; ++wrong) {
        const double weight = std::exp(log_weights[static_cast<std::size_t>(wrong)] - most);
        sum += weight;
        int count = 0;
        for (int k = 0; k < nominal_coordinates; ++k) {
            if (!is_in(wrong, k)) continue;
            stated.wrong[k] += weight;
            ++count;
        }
        if (count == 1) stated.one_alone += weight;
    }
    stated.wrong /= sum;
    stated.one_alone /= sum;
    stated.log_gain = most + std::log(sum) - log_evidence(told, Eigen::Vector3d::Ones());
    return stated;
}

BenchKnowledge undescribed_bench(const Recording& recording) {
    constexpr double by_factors = 1.0;
    // Nobody zeroed the sensors or stated their range, and bearings may take a third of a small drive's
    // torque.
    constexpr double zero_part = 0.1;
    constexpr double bearing_part = 0.3;
    const NominalSpread unknown{by_factors, by_factors, by_factors};
    BenchKnowledge bench{ratios(unknown, unknown)};
    add_zeros_and_bearings(recording, zero_part, bearing_part, bench);
    bench.numbers.push_back(presliding_of_bearings());
    if (recording.mode == BenchMode::pull_pull) {
        add_bends(bench);
        bench.numbers.push_back(radius_of_load_pulley(is_held_by_a_spring(recording)));
    }
    add_undescribed_parts(*recording.nominal, by_factors, bench);
    return bench;
}

}  // namespace capstan::gap
