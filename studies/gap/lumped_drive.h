#pragma once

#include "capstan/gap/twin.h"

namespace capstan::gap {

/// Which way a drive's channels count, read off the recording itself: seen from the motor angle.
struct DriveOrientation {
    double load_per_motor_angle = 1.0;  ///< slope of the load angle over the motor angle
    double motor_torque_sign = 1.0;     ///< +1 if a positive torque turns the motor angle up
    double load_torque_sign = 1.0;      ///< +1 if the load torque adds to the motor's with its sign
};

/// The motor torque must work against friction, and carry the load. Throws InvalidInput if the recording's
/// motion shows neither.
DriveOrientation drive_orientation(const Recording& recording);

/// Twin of a drive whose geometry is not known, as a pull-pull pair (E15-E17) with all wrap and friction in
/// one exponent and the motor pulley's radius in the units: motor_angle and load_torque drive it, it predicts
/// motor_torque and, up to its zero, load_angle. Parameters: friction_exponent (mu_d times wrap angle),
/// stiffness (of one cable at the motor pulley), pretension (torque of one cable's pretension about it),
/// speed_ratio.
std::unique_ptr<Twin> make_lumped_drive_twin(const Recording& recording);

}  // namespace capstan::gap
