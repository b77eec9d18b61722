#pragma once

#include <string_view>

namespace capstan {

/// What a sensor measures. Tensions are in N, displacements in m.
enum class SensorKind {
    tension,            ///< of a cable, anywhere along it
    motor_torque,       ///< tension at the proximal end, as the motor's torque over its pulley's radius shows
                        ///< it; of a pull-pull pair that of cable A less that of cable B (E16)
    load_torque,        ///< the same at the distal end
    load_displacement,  ///< of the distal end, of a pair that of cable A: an encoder at the joint
};

inline constexpr SensorKind all_sensor_kinds[] = {SensorKind::tension, SensorKind::motor_torque,
                                                  SensorKind::load_torque, SensorKind::load_displacement};
constexpr std::string_view name_of(SensorKind kind) {
    switch (kind) {
        case SensorKind::tension:
            return "tension";
        case SensorKind::motor_torque:
            return "motor_torque";
        case SensorKind::load_torque:
            return "load_torque";
        case SensorKind::load_displacement:
            return "load_displacement";
    }
    return {};
}
constexpr bool measures_tension(SensorKind kind) {
    return kind != SensorKind::load_displacement;
}

/// The errors of a sensor as standard deviations, in the unit of what it measures (E9 with a gain):
/// reading = true (1 + gain_ratio e1 + multiplicative_ratio e2) + zero e3 + additive e4. e1 and e3 belong to
/// the sensor and stay; e2 and e4 are new in every reading.
struct SensorErrors {
    double multiplicative_ratio = 0.0;
    double additive = 0.0;
    double zero = 0.0;
    double gain_ratio = 0.0;

    bool operator==(const SensorErrors&) const = default;
};

/// A sensor that can be had at a place.
struct SensorOffer {
    SensorKind kind = SensorKind::tension;
    double place_m = 0.0;  ///< arc length from the proximal end
    SensorErrors errors;
    double price = 1.0;  ///< in whatever unit the maker counts
    int cable = 0;       ///< of a tension sensor on a pair: 0 on cable A, 1 on cable B
};

}  // namespace capstan
