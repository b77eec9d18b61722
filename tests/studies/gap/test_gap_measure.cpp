#include <gtest/gtest.h>

#include <cmath>

#include "capstan/gap/gap_measure.h"
#include "session_with_effects.h"

namespace capstan::gap {
namespace {

BenchNumbers with_drag() {
    BenchNumbers numbers;
    numbers.effects.of<ViscousFriction>().drag_N_s_per_m2 = 4.0;
    return numbers;
}

class MeasuredGap : public testing::Test {
  protected:
    const Recording recording = exact_session(with_drag(), coarse_twin);
    const CauseFitter fitter{recording, coarse_twin, 1};

    GapMeasure measured(const BenchNumbers& leading, const BenchNumbers& held_out) const {
        GapModels models{leading, {}, {}};
        for (const LeftOut& part : left_out_in_turn(recording.runs.size(), {}))
            models.held_out.push_back({part, held_out});
        return measure_gap(recording, fitter, models);
    }
};

TEST(LeftOutInTurn, IsEachRunOrEachHalfOfASingleRun) {
    const std::vector<LeftOut> runs = left_out_in_turn(2, {});
    ASSERT_EQ(runs.size(), 2u);
    EXPECT_TRUE(runs[0].is_complete_run());
    EXPECT_EQ(runs[1].run, 1u);
    const std::vector<LeftOut> halves = left_out_in_turn(1, {});
    ASSERT_EQ(halves.size(), 2u);
    EXPECT_EQ(halves[0].rows(100), std::pair(std::size_t{0}, std::size_t{50}));
    EXPECT_EQ(halves[1].rows(100), std::pair(std::size_t{50}, std::size_t{100}));
}

TEST(LeftOutInTurn, IsEachHalfOfARunWhereOnlyAllRunsTogetherTellANumber) {
    CandidateCause drift;
    drift.effect = "pretension_drift";
    CandidateCause with_roll;
    with_roll.varies = "roll_deg";
    with_roll.is_of_runs = true;
    CandidateCause tensioned_anew;
    tensioned_anew.is_of_runs = true;
    CandidateCause drag;
    drag.effect = "viscous_friction";
    for (const CandidateCause* between_runs : {&drift, &with_roll, &tensioned_anew}) {
        const std::vector<LeftOut> halves = left_out_in_turn(3, {&drag, between_runs});
        ASSERT_EQ(halves.size(), 6u);
        EXPECT_FALSE(halves[5].is_complete_run());
        EXPECT_EQ(halves[5].run, 2u);
    }
    EXPECT_EQ(left_out_in_turn(3, {&drag}).size(), 3u);
}

TEST_F(MeasuredGap, TheTrueModelLeavesNothingAndClosesTheGap) {
    const GapMeasure gap = measured(with_drag(), with_drag());
    ASSERT_FALSE(gap.channels.empty());
    for (const ChannelGap& channel : gap.channels) {
        EXPECT_GT(channel.before_rms, 0.0) << channel.channel;
        EXPECT_EQ(channel.after_rms, 0.0) << channel.channel;
        if (!std::isnan(channel.closed)) {
            EXPECT_EQ(channel.closed, 1.0) << channel.channel;
        }
    }
}

TEST_F(MeasuredGap, HeldOutErrorsUseOnlyTheNumbersFittedWithoutThatPart) {
    for (const ChannelGap& channel : measured(with_drag(), {}).channels) {
        EXPECT_EQ(channel.after_rms, 0.0) << channel.channel;
        EXPECT_EQ(channel.held_out_rms, channel.before_rms) << channel.channel;
    }
    for (const ChannelGap& channel : measured({}, with_drag()).channels) {
        EXPECT_EQ(channel.after_rms, channel.before_rms) << channel.channel;
        EXPECT_EQ(channel.held_out_rms, 0.0) << channel.channel;
    }
}

TEST_F(MeasuredGap, AFaultOfTheNamedSensorIsPartOfTheLeadingModel) {
    BenchNumbers offset = with_drag();
    offset.sensor_faults["load_torque"].offset = 0.5;
    for (const ChannelGap& channel : measured(offset, {}).channels)
        EXPECT_NEAR(channel.after_rms, channel.channel == "load_torque" ? 0.5 : 0.0, 1e-12);
}

TEST_F(MeasuredGap, WithoutAGapThereIsNoFractionToClose) {
    const Recording ideal = exact_session({}, coarse_twin);
    const CauseFitter ideal_fitter(ideal, coarse_twin, 1);
    GapModels models;
    for (const LeftOut& part : left_out_in_turn(ideal.runs.size(), {})) models.held_out.push_back({part, {}});
    const GapMeasure gap = measure_gap(ideal, ideal_fitter, models);
    for (const ChannelGap& channel : gap.channels) EXPECT_TRUE(std::isnan(channel.closed));
    EXPECT_TRUE(gap.map.empty());
}

}  // namespace
}  // namespace capstan::gap
