#pragma once

#include <string>
#include <vector>

namespace capstan {

/// What a faulty sensor or its wiring makes of a true signal, in this order: hysteresis, lag, delay,
/// gain, offset and drift, clipping, quantisation. By default the sensor has no fault.
struct SensorFaults {
    double hysteresis = 0.0;  ///< half the width of the loop that the reading makes of a slow cycle
    /// How the loop closes after a reversal: 0 a play, which moves nothing until it is crossed; 0.5
    /// Rayleigh's law; 1 exponentially (E65).
    double loop_exponent = 0.5;
    double lag_s = 0.0;    ///< time constant of a first-order low-pass (E66)
    double delay_s = 0.0;  ///< time misalignment; negative: the reading comes early (E66)
    double gain = 1.0;
    double offset = 0.0;
    double drift_by_100_s = 0.0;  ///< how far the offset has moved 100 s after the session began
    double limit = 0.0;           ///< no reading is larger, either way; 0: none
    double step = 0.0;            ///< readings are multiples of it

    bool none() const {
        return hysteresis == 0.0 && lag_s == 0.0 && delay_s == 0.0 && gain == 1.0 && offset == 0.0 &&
               drift_by_100_s == 0.0 && limit == 0.0 && step == 0.0;
    }
    /// What is read of a signal that is 0.
    double zero_at(double session_time_s) const {
        constexpr double reference_s = 100.0;
        return offset + drift_by_100_s * session_time_s / reference_s;
    }
};

/// The readings of a signal sampled every `time_step_s`, the first at `session_time_s`. Before its first
/// sample it was constant.
std::vector<double> sensed(std::vector<double> signal, const SensorFaults& faults, double time_step_s,
                           double session_time_s = 0.0);

/// One kind of fault.
struct SensorFault {
    enum class Size { positive, either_sign, lattice, limit };
    enum class TypicalOf { absolute, channel_span, time_step };

    std::string name;       ///< canonical
    std::string variant{};  ///< distinguishes faults of one name; empty for the first of them
    std::string title;
    std::string unit{};           ///< empty where `typical_of` is the channel's span: that of the channel
    std::string number = "size";  ///< what its size is
    Size size = Size::positive;
    double typical = 1.0;
    TypicalOf typical_of = TypicalOf::absolute;  ///< what `typical` is a multiple of
    double SensorFaults::*value = nullptr;
    /// How it looks, if that is a number, too; it has no unit.
    struct Shape {
        std::string name{};
        double low = 0.0;
        double high = 0.0;
        double SensorFaults::*value = nullptr;
    };
    Shape shape{};
    std::vector<std::string> confusable_with{};  ///< see EffectDescription
    std::string answered_as{};                   ///< see EffectDescription

    /// The variant of the cause that this fault is at a channel.
    std::string variant_at(const std::string& channel) const {
        return variant.empty() ? channel : channel + " " + variant;
    }
};
const std::vector<SensorFault>& sensor_fault_catalogue();

}  // namespace capstan
