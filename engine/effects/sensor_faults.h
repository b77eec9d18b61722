#pragma once

#include <string>
#include <vector>

namespace capstan {

/// What a faulty sensor or its wiring makes of a true signal, in this order: hysteresis, lag, delay,
/// gain, offset, quantisation. By default the sensor has no fault.
struct SensorFaults {
    double hysteresis = 0.0;  ///< half the width of the loop that the reading makes of a slow cycle
    double lag_s = 0.0;       ///< time constant of a first-order low-pass
    double delay_s = 0.0;     ///< time misalignment; negative: the reading comes early
    double gain = 1.0;
    double offset = 0.0;
    double step = 0.0;  ///< readings are multiples of it

    bool none() const {
        return hysteresis == 0.0 && lag_s == 0.0 && delay_s == 0.0 && gain == 1.0 && offset == 0.0 &&
               step == 0.0;
    }
};

/// The readings of a signal sampled every `time_step_s`. Before its first sample it was constant.
std::vector<double> sensed(std::vector<double> signal, const SensorFaults& faults, double time_step_s);

/// One kind of fault.
struct SensorFault {
    enum class Size { positive, either_sign, lattice };
    enum class TypicalOf { absolute, channel_span, time_step };

    std::string name;  ///< canonical
    std::string title;
    std::string unit{};
    Size size = Size::positive;
    double typical = 1.0;
    TypicalOf typical_of = TypicalOf::absolute;  ///< what `typical` is a multiple of
    double SensorFaults::*value = nullptr;
    std::vector<std::string> confusable_with{};  ///< see EffectDescription
};
const std::vector<SensorFault>& sensor_fault_catalogue();

}  // namespace capstan
