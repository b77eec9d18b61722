#pragma once

#include <optional>
#include <vector>

namespace capstan::imports {

/// How far a channel's clock is from that of others.
struct ClockOffset {
    double offset_s = 0.0;  ///< to be added to the channel's times
    /// Half the 95% interval that estimates from separate quarters of the samples give (Student's t), or how
    /// far the farthest shift is that explains the channel as well within the error of the model, whichever
    /// is larger.
    double uncertainty_s = 0.0;
    double unexplained = 1.0;  ///< part of the channel's variance that the others leave at this offset
    double unexplained_at_zero = 1.0;
};

/// A channel that explains another one.
struct ClockReference {
    std::vector<double> values;
    bool is_angle = false;  ///< its speed may drive a viscous friction
    bool with_friction =
        true;  ///< the channel may follow it with hysteresis; a model's prediction has it already
};

/// The time shift at which a channel follows from others best. The others explain it through their values and
/// through friction: elastic-plastic (stop) elements of several yields, which are independent of the rate. So
/// friction's lag is told from a clock's, which is the same at every rate. A viscous friction lags as a clock
/// does, so that the speeds of angles are beside it. All samples have one rate, `channel` and each of
/// `others` the same number of them. Nothing where the channel is not explained by the others at any shift up
/// to `longest_s`, or where the quarters disagree.
std::optional<ClockOffset> find_clock_offset(const std::vector<double>& channel,
                                             const std::vector<ClockReference>& others, double sample_rate_Hz,
                                             double longest_s, double model_error);

}  // namespace capstan::imports
