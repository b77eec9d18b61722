#include <gtest/gtest.h>

#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/gap/equivalent_bench.h"
#include "capstan/model_comparison/model_comparison.h"
#include "lumped_session.h"

namespace capstan::model_comparison {
namespace {

Recording runs_numbered(int count) {
    Recording recording;
    for (int number = 1; number <= count; ++number) {
        recording.runs.emplace_back();
        recording.runs.back().number = number;
    }
    return recording;
}

TEST(AlternatingSplits, HoldEveryRunOutOnceAndNeverFitWhatTheyJudge) {
    const std::vector<RunSplit> splits = alternating_splits(runs_numbered(5));
    ASSERT_EQ(splits.size(), 2u);
    EXPECT_EQ(splits[0].fit, (std::vector{1, 3, 5}));
    EXPECT_EQ(splits[0].hold, (std::vector{2, 4}));
    EXPECT_EQ(splits[1].fit, splits[0].hold);
    EXPECT_EQ(splits[1].hold, splits[0].fit);
}

TEST(AlternatingSplits, HoldNothingOutOfASingleRun) {
    const std::vector<RunSplit> splits = alternating_splits(runs_numbered(1));
    ASSERT_EQ(splits.size(), 1u);
    EXPECT_TRUE(splits.front().hold.empty());
}

TEST(RunsOf, KeepTheOrderOfTheNumbersAndNameARunThatIsMissing) {
    const Recording some = runs_of(runs_numbered(4), {3, 1});
    EXPECT_EQ(some.runs.front().number, 3);
    EXPECT_EQ(some.runs.back().number, 1);
    EXPECT_THROW(runs_of(runs_numbered(4), {5}), InvalidInput);
}

TEST(Predictions, OfABandAreInItsOwnTensionsAndUnits) {
    Recording band;
    band.mode = BenchMode::capstan_band;
    band.channels = {{"displacement", "m", {}, {}}, {"tension_1", "N", {}, {}}, {"tension_2", "N", {}, {}}};
    band.runs.emplace_back();
    band.runs.back().values = {{0.0, 1.0, 2.0}, {10.0, 30.0, 20.0}, {5.0, 5.0, 5.0}};
    Recording bench = band;
    bench.mode = BenchMode::single_cable;
    bench.channels = {
        {"motor_torque", "N m", {}, {}}, {"motor_angle", "rad", {}, {}}, {"load_torque", "N m", {}, {}}};
    bench.runs.back().values = {{0.2, 0.6, 0.4}, {0.0, 50.0, 100.0}, {0.1, 0.1, 0.1}};  // a radius of 20 mm
    gap::TwinRun twin;
    twin.values = {{0.4, 0.4, 0.4}, {}, {0.3, 0.1, 0.1}};
    const Predictions predictions = in_recorded_channels(band, bench, {twin});
    EXPECT_TRUE(predictions.values[0][0].empty());  // driven
    for (const double tension_N : predictions.values[0][1]) EXPECT_NEAR(tension_N, 20.0, 1e-9);
    // A channel that never changes has no scale to read off; its deviation stays in the bench's unit.
    EXPECT_NEAR(predictions.values[0][2][0], 5.2, 1e-9);
}

TEST(RmsOverRuns, CountsEveryRunAlike) {
    EXPECT_FALSE(rms_over_runs({}).has_value());
    EXPECT_NEAR(*rms_over_runs({{1, 3.0}, {2, 4.0}}), std::sqrt(12.5), 1e-12);
}

class DriveOfUnknownGeometry : public testing::Test {
  protected:
    // The diagnosis found nothing: what is corrected is what was calibrated.
    DriveOfUnknownGeometry() {
        const Recording session = gap::lumped_session({});
        split.split = {{1}, {2}};
        split.recorded = session;
        split.bench = gap::equivalent_bench(session, runs_of(session, {1}));
        split.diagnosed = runs_of(split.bench, {1});
        add_split(comparison, split, Compared::with_simple_models, {});
    }

    const ModelErrors& model(const std::string& channel, const std::string& name) const {
        for (const OutputComparison& output : comparison.outputs)
            for (const ModelErrors& each : output.models)
                if (output.channel == channel && each.name == name) return each;
        throw std::out_of_range(name);
    }

    DiagnosedSplit split;
    ModelComparison comparison;
};

TEST_F(DriveOfUnknownGeometry, IsComparedOnBothRunsByEveryModel) {
    ASSERT_EQ(comparison.outputs.size(), 2u);  // motor torque and load angle
    for (const OutputComparison& output : comparison.outputs) {
        EXPECT_EQ(output.models.size(), 8u) << output.channel;
        for (const ModelErrors& each : output.models) {
            ASSERT_EQ(each.fitted.size(), 1u) << each.name;
            ASSERT_EQ(each.held_out.size(), 1u) << each.name;
            EXPECT_EQ(each.fitted.front().run, 1);
            EXPECT_EQ(each.held_out.front().run, 2);
        }
    }
}

TEST_F(DriveOfUnknownGeometry, IsMetByTheBenchOnARunItWasNotCalibratedTo) {
    // The session is one of the bench's own law, which no simple model is. Its torque spans about 1 N m.
    const double ours = model("motor_torque", "calibrated").held_out.front().rms;
    EXPECT_LT(ours, 0.02);
    EXPECT_LT(ours, model("motor_torque", "linear").held_out.front().rms);
    EXPECT_LT(ours, model("motor_torque", "closed_form").held_out.front().rms);
}

TEST_F(DriveOfUnknownGeometry, IsLeftAsItWasWhereTheDiagnosisFoundNothing) {
    for (const char* channel : {"motor_torque", "load_angle"}) {
        EXPECT_EQ(model(channel, "corrected").held_out.front().rms,
                  model(channel, "calibrated").held_out.front().rms);
    }
}

}  // namespace
}  // namespace capstan::model_comparison
