#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "capstan/gap/effects_twin.h"
#include "capstan/recording/recording.h"

namespace capstan::gap {

/// A number of the bench that floats in every fit, within what a laboratory knows of it.
struct FloatingNumber {
    enum class Kind {
        ratio,  ///< the coordinate is the logarithm of the number over its nominal value, `scale`
        size,   ///< the coordinate is the number in units of `scale`, and not negative
        zero,   ///< the same with either sign
    };
    std::string name;
    std::string unit{};
    Kind kind = Kind::ratio;
    double scale = 1.0;
    double prior_std = 1.0;  ///< of the coordinate; its prior mean is 0
    bool of_a_sensor = false;
    /// Up to here the coordinate is usual, either way, and the number is not named as a cause.
    double usual = 0.0;
    /// Of the coordinate of a number that may well have been measured as it was stated; 0: none was stated.
    double measured_std = 0.0;
    /// The cause that it stands for where it is far from what was stated; no effect: none.
    std::string effect{};
    std::string variant{};
    std::string component{};
    std::string end{};
    std::function<void(BenchNumbers&, double value)> apply{};

    double value(double coordinate) const;
    bool is_far(double coordinate) const { return std::abs(coordinate) > usual; }
    /// Whether the search ended at the end of its range: the true number may lie beyond it.
    bool is_at_bound(double coordinate) const;
};

/// Logarithms of friction, stiffness and pretension over their nominal values.
inline constexpr int nominal_coordinates = 3;

/// What is known of a bench before a cause is sought. The first three numbers are always the friction, the
/// stiffness and the pretension over their nominal values.
struct BenchKnowledge {
    std::vector<FloatingNumber> numbers;

    Eigen::Index size() const { return static_cast<Eigen::Index>(numbers.size()); }
    /// Nothing floats but the three numbers.
    bool is_measured() const { return numbers.size() == nominal_coordinates; }
    /// Whether a number is known so roughly that a fit has to look for it first.
    bool has_unknown_number() const;
};

/// The uncertainty of the nominal numbers of a bench whose numbers were measured (standard deviation of the
/// logarithm): a calliper's, a load cell's and a tensile test's error of one to two per cent.
inline constexpr double nominal_log_std = 0.015;

/// A bench whose stated numbers were measured, with sensors that were zeroed and bearings without friction.
const BenchKnowledge& measured_bench();
/// The same, where the sidecar may state ranges of numbers or nothing.
BenchKnowledge measured_bench(const NominalSpread& stated);

/// A bench as it is built: friction and wrap from tables (20%), stiffness from a data sheet (10%), a tension
/// set by hand (15%), torque and tension sensors with a gain error (2%) and a zero error (10% of half of what
/// they read, from no load on), and bearings with Coulomb friction. Numbers that the sidecar states as ranges
/// are known as it says.
BenchKnowledge built_bench(const Recording& recording);

/// What a fit tells of the numbers that a sidecar states (E63).
struct StatedNumbers {
    /// The probability that each is not what was stated; 1 where none was.
    Eigen::Vector3d wrong = Eigen::Vector3d::Ones();
    /// That exactly one of them is wrong.
    double one_alone = 0.0;
    /// What it adds to the evidence that they may be as stated: the logarithm of a ratio.
    double log_gain = 0.0;
};

/// `coordinates` and `covariance`: of the first three numbers, as a fit left them with their priors in
/// `bench`.
StatedNumbers weigh_stated_numbers(const BenchKnowledge& bench, const Eigen::Vector3d& coordinates,
                                   const Eigen::Matrix3d& covariance);

/// A drive or band whose numbers nobody stated: `recording` is its equivalent bench, whose numbers were
/// fitted. All of them float by factors, and of a drive where its conduit bends.
BenchKnowledge undescribed_bench(const Recording& recording);

}  // namespace capstan::gap
