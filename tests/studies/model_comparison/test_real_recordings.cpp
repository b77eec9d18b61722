// Recordings of real drives, beside simple models that are fitted to the same runs. They are not part of this
// repository; a test that needs one says so and skips where it is not. A minute of both processors each.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <string>

#include "capstan/model_comparison/model_comparison.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::model_comparison {
namespace {

// Held out, rms over the runs.
struct HeldOut {
    double corrected = std::numeric_limits<double>::infinity();
    double best_simple = std::numeric_limits<double>::infinity();
};

HeldOut held_out(const OutputComparison& output) {
    static const std::set<std::string> of_the_bench = {"nominal", "calibrated", "corrected",
                                                       "corrected_with_law"};
    HeldOut errors;
    for (const ModelErrors& model : output.models) {
        const double rms = rms_over_runs(model.held_out).value();
        if (model.name == "corrected") errors.corrected = rms;
        if (!of_the_bench.contains(model.name)) errors.best_simple = std::min(errors.best_simple, rms);
    }
    return errors;
}

ModelComparison compared(const Recording& recording, const std::vector<RunSplit>& splits) {
    ModelComparison comparison;
    for (const RunSplit& split : splits)
        add_split(comparison, diagnose_split(recording, split, {}), Compared::with_simple_models, {});
    return comparison;
}

class SlowRealGraspers : public testing::TestWithParam<const char*> {};

TEST_P(SlowRealGraspers, TheCorrectedTorqueIsNoWorseThanThatOfTheBestSimpleModel) {
    const std::string file = std::string(CAPSTAN_REAL_RECORDINGS) + "/davinci-grip/" + GetParam() + ".csv";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
    const Recording recording = read_recording(file);
    RunSplit split{.fit = {1, 3, 5}, .hold = {}};
    for (const RecordedRun& run : recording.runs) {
        if (std::find(split.fit.begin(), split.fit.end(), run.number) == split.fit.end())
            split.hold.push_back(run.number);
    }
    const ModelComparison comparison = compared(recording, {split});
    const auto torque =
        std::find_if(comparison.outputs.begin(), comparison.outputs.end(),
                     [](const OutputComparison& output) { return output.channel == "motor_torque"; });
    ASSERT_NE(torque, comparison.outputs.end());
    const HeldOut errors = held_out(*torque);
    ASSERT_TRUE(std::isfinite(errors.best_simple));
    EXPECT_LE(errors.corrected, errors.best_simple);
}

INSTANTIATE_TEST_SUITE_P(Recordings, SlowRealGraspers, testing::Values("right_jaw", "tool4", "tool4_more"));

TEST(SlowRealBandBrake, TheCorrectedTensionsAreNoWorseThanThoseOfTheBestSimpleModel) {
    const std::string file = std::string(CAPSTAN_REAL_RECORDINGS) + "/band-brake/band.csv";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
    const Recording recording = read_recording(file);
    const ModelComparison comparison = compared(recording, alternating_splits(recording));
    ASSERT_EQ(comparison.outputs.size(), 2u);
    for (const OutputComparison& output : comparison.outputs) {
        const HeldOut errors = held_out(output);
        ASSERT_TRUE(std::isfinite(errors.best_simple));
        EXPECT_LE(errors.corrected, errors.best_simple) << output.channel;
    }
}

}  // namespace
}  // namespace capstan::model_comparison
