#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "capstan/gap/candidate_cause.h"
#include "capstan/gap/gap_map.h"
#include "capstan/recording/channel_range.h"
#include "capstan/recording/driven_inputs.h"
#include "sample_recording.h"

namespace capstan::gap {
namespace {

// Residuals of noise, five times as large in one run.
std::vector<RunResiduals> larger_in(const Recording& recording, std::size_t loud) {
    std::mt19937_64 random(20260203);
    std::normal_distribution<double> normal;
    std::vector<RunResiduals> runs;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const auto samples = recording.runs[run].time_s.size();
        RunResiduals residuals{run, std::vector<std::vector<double>>(recording.channels.size()),
                               std::vector<double>(samples, 1.0), 0};
        for (std::size_t k = 0; k < samples; ++k)
            residuals.residual[3].push_back((run == loud ? 5.0 : 1.0) * normal(random));
        runs.push_back(std::move(residuals));
    }
    return runs;
}

const GapFraction* part(const std::vector<GapFraction>& map, const std::string& by, const std::string& name) {
    for (const GapFraction& fraction : map) {
        if (fraction.by == by && fraction.name == name) return &fraction;
    }
    return nullptr;
}

TEST(GapMap, FindsTheRunThatHoldsTheGap) {
    const Recording recording = measured_session(nominal_values(*make_twin(driven_session())));
    const std::vector<GapFraction> map = gap_map(recording, larger_in(recording, 1));
    const GapFraction* loud = part(map, "run", "2");
    ASSERT_NE(loud, nullptr);
    EXPECT_GT(loud->fraction, 0.95);
    EXPECT_LE(loud->low, loud->fraction);
    EXPECT_GE(loud->high, loud->fraction);
    EXPECT_NEAR(loud->of_samples, 0.5, 0.01);
    EXPECT_NE(gap_sentence(map).find("run 2"), std::string::npos);
}

TEST(GapMap, FractionsOfAKindSumToOne) {
    const Recording recording = measured_session(nominal_values(*make_twin(driven_session())));
    double direction = 0.0;
    for (const GapFraction& fraction : gap_map(recording, larger_in(recording, 0))) {
        if (fraction.by == "direction") direction += fraction.fraction;
    }
    EXPECT_NEAR(direction, 1.0, 1e-12);
}

TEST(GapMap, SortsNoSampleBeforeTheFirstThatIsCompared) {
    const Recording recording = measured_session(nominal_values(*make_twin(driven_session())));
    std::vector<RunResiduals> runs = larger_in(recording, 0);
    runs[1].first_sample = 30;
    for (const SampleSorting& sorting : sample_sortings(recording, runs)) {
        const std::vector<int>& part_of = sorting.part_of[1];
        EXPECT_TRUE(std::all_of(part_of.begin(), part_of.begin() + 30, [](int part) { return part == -1; }))
            << sorting.by;
        EXPECT_TRUE(std::any_of(part_of.begin() + 30, part_of.end(), [](int part) { return part >= 0; }))
            << sorting.by;
    }
}

TEST(GapMap, IsEmptyWithoutAGap) {
    const Recording recording = measured_session(nominal_values(*make_twin(driven_session())));
    std::vector<RunResiduals> quiet = larger_in(recording, 0);
    for (RunResiduals& run : quiet) {
        for (double& residual : run.residual[3]) residual *= 0.1;
    }
    EXPECT_TRUE(gap_map(recording, quiet).empty());
}

TEST(EstimatedNoise, IsTheNoiseOfTheSamples) {
    Recording recording = driven_session();
    const auto channel = static_cast<std::size_t>(*recording.channel("load_torque"));
    recording.channels[channel].noise_std.reset();
    std::mt19937_64 random(20260204);
    std::normal_distribution<double> normal(0.0, 0.03);
    for (RecordedRun& run : recording.runs) {
        run.values[channel].clear();
        for (const double time_s : run.time_s)
            run.values[channel].push_back(std::sin(time_s) + normal(random));
    }
    EXPECT_NEAR(*with_estimated_noise(recording).channels[channel].noise_std, 0.03, 0.002);
}

TEST(EstimatedNoise, IsZeroWhereTheStatedStepExplainsIt) {
    Recording recording = driven_session();
    const auto channel = static_cast<std::size_t>(*recording.channel("motor_angle"));
    recording.channels[channel].noise_std.reset();
    recording.channels[channel].step = 0.01;
    for (RecordedRun& run : recording.runs) {
        run.values[channel].clear();
        for (const double time_s : run.time_s)
            run.values[channel].push_back(0.01 * std::round(std::sin(time_s) / 0.01));
    }
    EXPECT_EQ(*with_estimated_noise(recording).channels[channel].noise_std, 0.0);
}

TEST(UnstatedStep, IsFoundWhereValuesLieOnALattice) {
    Recording recording = driven_session();
    const auto channel = static_cast<std::size_t>(*recording.channel("load_torque"));
    for (RecordedRun& run : recording.runs) {
        run.values[channel].clear();
        for (const double time_s : run.time_s) run.values[channel].push_back(std::sin(time_s));
    }
    EXPECT_FALSE(unstated_step(recording, channel).has_value());
    for (RecordedRun& run : recording.runs) {
        for (double& value : run.values[channel]) value = 0.07 * std::round(value / 0.07);
    }
    ASSERT_TRUE(unstated_step(recording, channel).has_value());
    EXPECT_NEAR(*unstated_step(recording, channel), 0.07, 1e-9);
}

// Twice as coarse as the encoder is stated to be, with thousands of steps in the range and six decimals in
// the file: hardly any value occurs often.
TEST(UnstatedStep, IsFoundOfAFineLatticeWhereAFinerOneIsStated) {
    Recording recording = driven_session();
    const auto channel = static_cast<std::size_t>(*recording.channel("motor_angle"));
    const auto write = [&](double step) {
        for (RecordedRun& run : recording.runs) {
            run.values[channel].clear();
            for (const double time_s : run.time_s) {
                const double read = step * std::round(2.0 * std::sin(time_s) / step);
                run.values[channel].push_back(1e-6 * std::round(read / 1e-6));
            }
        }
    };
    recording.channels[channel].step = 0.000785398;
    write(0.000785398);
    EXPECT_FALSE(unstated_step(recording, channel).has_value());
    write(0.0018054);
    ASSERT_TRUE(unstated_step(recording, channel).has_value());
    EXPECT_NEAR(*unstated_step(recording, channel), 0.0018054, 1e-8);
    recording.channels[channel].step.reset();
    EXPECT_FALSE(unstated_step(recording, channel).has_value());
}

}  // namespace
}  // namespace capstan::gap
