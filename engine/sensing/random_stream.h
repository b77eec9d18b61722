#pragma once

#include <array>
#include <cstdint>

namespace capstan {

/// What a random number is for; two purposes never share a number.
enum class RandomPurpose : std::uint32_t {
    reading_noise = 1,  ///< drawn anew for each scenario
    sensor_bias = 2,    ///< the same at every scenario: its address leaves the scenario at 0
    member_motion = 3,  ///< of the recursive estimator; `repetition` is its step
    // Of an uncertain world: `repetition` is the world.
    world_cable = 4,     ///< `node` is the parameter
    world_far_end = 5,   ///< `scenario` is the sample
    world_sensor = 6,    ///< zero and gain; `node` is the sensor
    world_reading = 7,   ///< `scenario` is the sample, `node` the sensor
    member_cable = 8,    ///< `scenario` is the member, `node` the parameter
    member_far_end = 9,  ///< `scenario` is the sample, `node` the member
    member_sensor = 10,  ///< `scenario` is the member, `node` the sensor
    bench_reading =
        12,  ///< of a simulated recording: `scenario` is the sample, `repetition` the run, `node` the channel
    centre_line = 11,  ///< `scenario` is the point, `repetition` the replicate, `node` the coordinates
    driven_reading = 13,  ///< of a recorded channel that drives a model: `seed` is the measurement, `scenario`
                          ///< the sample, `repetition` the run, `node` the channel
};

/// Where a random number lives: the same address gives the same number, whoever asks, in whatever order.
struct RandomAddress {
    std::uint64_t seed = 0;
    RandomPurpose purpose = RandomPurpose::reading_noise;
    std::uint32_t scenario = 0;
    std::uint32_t repetition = 0;
    std::uint32_t node = 0;
};

/// Two independent standard normal numbers: Philox4x32-10 (Salmon et al. 2011) and Box-Muller.
std::array<double, 2> standard_normals(const RandomAddress& address);

}  // namespace capstan
