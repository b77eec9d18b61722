#pragma once

#include <string>
#include <vector>

#include "capstan/estimation/recursive_estimator.h"
#include "capstan/recording/recording.h"

namespace capstan::estimate {

/// A channel of a recording that measures the tension at one place of a cable.
struct SensedChannel {
    std::string name;
    double position_m = 0.0;  ///< from the motor end
    double noise_N = 0.0;     ///< standard deviation of one sample
};

struct SensedRun {
    int number = 0;
    std::string protocol;
    double pretension_N = 0.0;
    std::vector<double> time_s;                  // samples
    std::vector<KnownEnds> ends;                 // samples
    std::vector<std::vector<double>> reading_N;  // channels x samples
    double friction_ratio = 1.0;                 ///< on the cable's friction, in this run
};

/// A cable with one of its numbers a standard deviation off: factors on what is believed.
struct ShiftedCable {
    double friction_ratio = 1.0;
    double stiffness_ratio = 1.0;
    double pretension_ratio = 1.0;
    double viscous_ratio = 1.0;   ///< on the drag of E20
    double stribeck_ratio = 1.0;  ///< on the extra friction of E21

    bool is_shifted() const;
};

/// One cable of a recorded bench: the motion of its ends and the readings of its tension.
struct SensedCable {
    std::string name;  ///< "A", "B"
    CableSpecification specification;
    std::vector<SensedChannel> channels;
    std::vector<SensedRun> runs;
    /// One for each uncertain number; none: the numbers are taken for exact.
    std::vector<ShiftedCable> uncertain{};
    RateFriction rate_friction{};
    double interval_s = 0.0;  ///< between samples

    /// The cable in one of its runs.
    CableSpecification specification_in(const SensedRun& run) const;
};

/// Every cable of a recording that carries a tension sensor, cut into `segments`. Both ends move with the
/// measured pulley angles, freed of noise (E15); a single cable's far end stays. A single cable's torque
/// channels that drive nothing are tensions at its ends too; those of a pair tell of both cables together
/// and are not used. Noise that the sidecar does not state is estimated. Throws InvalidInput if there is no
/// tension sensor, no geometry, or an end whose motion was not measured.
std::vector<SensedCable> sensed_cables(const Recording& recording, int segments);

}  // namespace capstan::estimate
