#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capstan/gap/effects_twin.h"
#include "capstan/rig/channel_names.h"
#include "sample_recording.h"

namespace capstan::gap {
namespace {

// Of a handle moved to and fro so quickly that it turns between the samples of a coarse twin.
Recording quickly_turned() {
    Recording recording = driven_session();
    RecordedRun& run = recording.runs[1];
    std::vector<double>& angle_rad =
        run.values[static_cast<std::size_t>(*recording.channel(channel::load_angle))];
    for (std::size_t sample = 0; sample < angle_rad.size(); ++sample) {
        constexpr double period = 46.0;  // samples: turns at 23, 46, 69...
        const double phase = static_cast<double>(sample) / period;
        angle_rad[sample] = 0.4 * (1.0 - std::abs(2.0 * (phase - std::floor(phase)) - 1.0));
    }
    return recording;
}

// An angle that is given tells its acceleration where it is, and not a step later.
TEST(EffectsTwin, AnInertiaTakesItsTorqueWhenTheLoadIsAccelerated) {
    constexpr double inertia_kg_m2 = 0.01;
    constexpr double period = 80.0;  // samples
    constexpr double amplitude_rad = 0.4;
    Recording recording = driven_session();
    RecordedRun& run = recording.runs[1];
    std::vector<double>& angle_rad =
        run.values[static_cast<std::size_t>(*recording.channel(channel::load_angle))];
    const auto phase = [](std::size_t sample) {
        return 2.0 * std::numbers::pi * static_cast<double>(sample) / period;
    };
    for (std::size_t sample = 0; sample < angle_rad.size(); ++sample)
        angle_rad[sample] = amplitude_rad * std::sin(phase(sample));
    const double most_Nm = inertia_kg_m2 * amplitude_rad *
                           std::pow(2.0 * std::numbers::pi / period * recording.sample_rate_Hz, 2);
    BenchNumbers heavy;
    heavy.effects.of<Inertia>().load_kg_m2 = inertia_kg_m2;
    const auto torque = static_cast<std::size_t>(*recording.channel(channel::load_torque));
    for (const int stride : {1, 4}) {
        const EffectsTwin twin(recording, {.segments = 12, .stride = stride});
        const std::vector<double> with = twin.run(1, heavy).values[torque];
        const std::vector<double> without = twin.run(1, {}).values[torque];
        for (std::size_t k = 5; k + 5 < with.size(); ++k) {
            const double expected_Nm = most_Nm * std::sin(phase(k * static_cast<std::size_t>(stride)));
            // The inputs are smoothed, which takes 3% here.
            EXPECT_NEAR(with[k] - without[k], expected_Nm, 0.05 * most_Nm) << stride << ", " << k;
        }
    }
}

// Friction is independent of the rate, so that only how far the cable went matters.
TEST(EffectsTwin, WithFewerSamplesStillTurnsWhereTheInputsTurn) {
    const Recording recording = quickly_turned();
    const auto torque = static_cast<std::size_t>(*recording.channel(channel::load_torque));
    const auto predicted = [&](int stride) {
        return EffectsTwin(recording, {.segments = 24, .stride = stride}).run(1, {}).values[torque];
    };
    const std::vector<double> all = predicted(1);
    const auto [least, most] = std::minmax_element(all.begin(), all.end());
    for (const int stride : {2, 4, 8}) {
        const std::vector<double> some = predicted(stride);
        ASSERT_EQ(some.size(),
                  (all.size() + static_cast<std::size_t>(stride) - 1) / static_cast<std::size_t>(stride));
        double off = 0.0;
        for (std::size_t k = 0; k < some.size(); ++k)
            off = std::max(off, std::abs(some[k] - all[k * static_cast<std::size_t>(stride)]));
        EXPECT_LT(off, 0.01 * (*most - *least)) << stride;
    }
}

}  // namespace
}  // namespace capstan::gap
