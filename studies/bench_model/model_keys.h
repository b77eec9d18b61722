#pragma once
// How the writer and the reader of a model name things alike.

#include <string>
#include <vector>

#include "capstan/bench_model/effect_numbers.h"

namespace capstan::bench_model {

inline constexpr const char* format_key = "bench_model_format";
inline constexpr int model_format = 1;
inline constexpr const char* interval_ending = "_interval_95";

/// "offset", "N m" -> "offset_Nm"
std::string key_with_unit(const std::string& name, const std::string& unit);
/// "local_bend", "cable A" -> "local_bend_cable_A"
std::string effect_key(const EffectNumbers& group);

/// A fault of a sensor as a model names it; `unit` is empty where it is the channel's.
struct FaultKey {
    std::string name;  ///< "offset"
    std::string unit;
    bool in_channel_unit = false;
    bool may_be_negative = false;
    double SensorFaults::*value = nullptr;
    std::string effect;  ///< canonical name of the fault that it is a number of
};
/// Those of the sizes, in the order of the catalogue, then those of the shapes.
const std::vector<FaultKey>& fault_keys();
/// "offset" -> "sensor_offset"; empty where there is no such fault.
std::string effect_of_fault(const std::string& name);

/// What a number that follows a condition belongs to.
inline constexpr const char* friction_change = "friction_log";
inline constexpr const char* pretension_change = "pretension_log";
inline constexpr const char* zero_change = "zero_of_";  ///< and a channel
/// Before each of them: its change with the square of the condition.
inline constexpr const char* squared_change = "squared_";

}  // namespace capstan::bench_model
