#pragma once

#include <algorithm>
#include <array>
#include <string>

namespace capstan::channel {

// The channels of a recorded bench, beside its tension sensors, which have names of their own.
inline constexpr const char* motor_angle = "motor_angle";
inline constexpr const char* motor_torque = "motor_torque";
inline constexpr const char* load_angle = "load_angle";
inline constexpr const char* load_torque = "load_torque";
/// Of the motor, where its torque was not recorded.
inline constexpr const char* motor_current = "motor_current";
/// What the engine predicts.
inline constexpr std::array all = {motor_angle, motor_torque, load_angle, load_torque};

}  // namespace capstan::channel

namespace capstan {

/// A channel's name as a sentence has it: "load torque".
inline std::string channel_words(std::string name) {
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

}  // namespace capstan
