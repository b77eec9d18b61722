#pragma once

#include <string>
#include <vector>

#include "capstan/sensing/sensor.h"

namespace capstan {

/// How a number of a cable is drawn about its nominal value, whose factor is 1.
enum class FactorDistribution {
    normal,   ///< of the factor's logarithm; 95% of the cables lie within the stated fraction
    uniform,  ///< the factor lies evenly within the stated fraction
};

/// What the far end does in a world.
enum class FarEndKind {
    random,      ///< FarEndMotion, drawn anew for every world
    prescribed,  ///< the motion of [motion.distal]; the estimator still assumes the random one
    recorded,    ///< a stretch of far_end_samples_m, which differs between worlds; the same is assumed
};

/// The effects that an estimator can know of; catalogue names.
inline constexpr const char* estimator_effects[] = {"viscous_friction", "stribeck"};

/// What is not known of the transmission that the sensors will be fitted to. Fractions of the nominal values.
struct Uncertainty {
    bool is_stated = false;  ///< the configuration has [uncertainty]
    FactorDistribution distribution = FactorDistribution::normal;
    double friction_fraction = 0.2;
    double wrap_fraction = 0.1;  ///< of every bend on its own
    double stiffness_fraction = 0.1;
    double pretension_fraction = 0.15;

    FarEndKind far_end = FarEndKind::random;
    double far_end_range_m =
        0.0;  ///< 95% of the time within plus and minus this; 0: as [motion.distal] moves
    double far_end_bandwidth_Hz = 2.0;
    std::string far_end_log;                ///< file that the samples came from
    std::vector<double> far_end_samples_m;  ///< recorded, at the rate of [motion]: more than its samples

    std::vector<std::string> known_effects;  ///< of [truth], of estimator_effects: known with their severity
    int members = 64;                        ///< of the estimator's ensemble
    double worlds_ratio = 1.0;               ///< the worlds' widths are this times what the estimator is told
    double truth_probability =
        1.0;  ///< that a world has what [truth] says; else it is about the nominal cable
};

/// The cables of a pair that a sensor can be had on.
enum class OfferedOn { both, cable_a, cable_b };

/// One or more sensors of a kind that can be bought, a row of [[sensor]].
struct SensorRow {
    SensorKind kind = SensorKind::tension;
    std::vector<double> places_m;  ///< of a tension sensor; empty: every node
    SensorErrors errors;
    double price = 1.0;
    OfferedOn cable = OfferedOn::both;  ///< of a tension sensor on a pull-pull pair
};

}  // namespace capstan
