#pragma once

#include <array>
#include <cstdint>

namespace capstan {

/// What a random number is for; two purposes never share a number.
enum class RandomPurpose : std::uint32_t {
    reading_noise = 1,  ///< drawn anew for each scenario
    sensor_bias = 2,    ///< the same at every scenario: its address leaves the scenario at 0
    member_motion = 3,  ///< of the recursive estimator; `repetition` is its step
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
