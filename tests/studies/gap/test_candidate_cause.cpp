#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capstan/gap/candidate_cause.h"
#include "sample_recording.h"

namespace capstan::gap {
namespace {

TEST(OpenNumber, IsAtABoundWhereItsSearchEnded) {
    const OpenNumber exponent{"n", "", OpenNumber::Kind::shape, 1.0, 1.0, 0.2, 3.0};
    EXPECT_FALSE(exponent.is_at_bound(exponent.value(0.5)));
    EXPECT_TRUE(exponent.is_at_bound(exponent.value(10.0)));
    EXPECT_TRUE(exponent.is_at_bound(exponent.value(-10.0)));
}

TEST(OpenNumber, IsNotAtABoundWhereTheCauseIsAbsent) {
    const OpenNumber drag{"drag", "N s/m2", OpenNumber::Kind::size, 2.0, 0.0, 0.0, 50.0};
    EXPECT_FALSE(drag.is_at_bound(drag.value(0.0)));
    EXPECT_TRUE(drag.is_at_bound(drag.value(100.0)));
}

TEST(FloatingNumber, IsAtABoundBeyondWhatABenchCanHave) {
    const FloatingNumber& pretension = measured_bench().numbers[2];
    EXPECT_FALSE(pretension.is_at_bound(0.3));
    EXPECT_TRUE(pretension.is_at_bound(-5.0));
    EXPECT_TRUE(pretension.is_at_bound(3.0));
}

// Between two counts of its encoder an angle turns back unseen.
TEST(CandidateCauses, HoldNoLostMotionOfLessThanHalfAStepOfTheEncoderAtItsEnd) {
    Recording recording = driven_session();
    recording.channels[static_cast<std::size_t>(*recording.channel("motor_angle"))].step = 4e-3;
    recording.channels[static_cast<std::size_t>(*recording.channel("load_angle"))].step = 1e-3;
    int ends = 0;
    for (const CandidateCause& cause : candidate_causes(recording)) {
        if (cause.effect != "backlash") continue;
        ++ends;
        EXPECT_DOUBLE_EQ(cause.numbers.front().value(1e-6), cause.end == "motor" ? 2e-3 : 5e-4);
    }
    EXPECT_EQ(ends, 2);
}

// A cable only pulls, so that its joints are loaded on one side.
TEST(CandidateCauses, HoldNoLostMotionOfASingleCable) {
    Recording recording = driven_session();
    const auto has_backlash = [&] {
        const std::vector<CandidateCause> causes = candidate_causes(recording);
        return std::any_of(causes.begin(), causes.end(),
                           [](const CandidateCause& cause) { return cause.effect == "backlash"; });
    };
    EXPECT_TRUE(has_backlash());
    recording.mode = BenchMode::single_cable;
    EXPECT_FALSE(has_backlash());
}

const CandidateCause& the_one(const std::vector<CandidateCause>& causes, const std::string& effect) {
    return *std::find_if(causes.begin(), causes.end(),
                         [&](const CandidateCause& cause) { return cause.effect == effect; });
}

// What repeats nothing is any function of the position. Half a period is enough on a drive of unknown
// geometry, where a smooth torque over the position competes with it.
TEST(CandidateCauses, HoldNoRippleOfWhichLessThanAPeriodWasSeen) {
    Recording recording = driven_session();
    const auto channel = static_cast<std::size_t>(*recording.channel("motor_angle"));
    const auto samples = recording.runs.front().time_s.size();
    for (const double turned_rad : {0.5, 1.0, 4.0, 20.0}) {
        for (RecordedRun& run : recording.runs) {
            run.values[channel].assign(samples, 0.0);
            run.values[channel].back() = turned_rad;
        }
        for (const bool is_undescribed : {false, true}) {
            recording.nominal_is_fitted = is_undescribed;
            const std::vector<CandidateCause> causes = candidate_causes(recording);
            const std::vector<OpenNumber>& numbers = the_one(causes, "motor_cogging").numbers;
            const auto periods = std::find_if(numbers.begin(), numbers.end(), [](const OpenNumber& number) {
                return number.kind == OpenNumber::Kind::periods;
            });
            ASSERT_NE(periods, numbers.end());
            const double seen_rad = (is_undescribed ? 1.0 : 2.0) * std::numbers::pi;
            EXPECT_EQ(periods->low, std::ceil(seen_rad / turned_rad)) << turned_rad << " rad";
        }
    }
}

// Radii and forces of a drive of unknown geometry are of an equivalent one.
TEST(CandidateCauses, SeekTheToeOfACableAtAboutTheTensionOfABenchOfUnknownGeometry) {
    Recording recording = driven_session();
    const double stated_N =
        the_one(candidate_causes(recording), "cable_stiffness_nonlinear").numbers[1].typical;
    for (RecordedRun& run : recording.runs) run.pretension_N = 0.3;
    EXPECT_EQ(the_one(candidate_causes(recording), "cable_stiffness_nonlinear").numbers[1].typical, stated_N);
    recording.nominal_is_fitted = true;
    const std::vector<CandidateCause> causes = candidate_causes(recording);
    const OpenNumber& toe_tension = the_one(causes, "cable_stiffness_nonlinear").numbers[1];
    EXPECT_DOUBLE_EQ(toe_tension.typical, 0.3);
    EXPECT_LT(toe_tension.low, 0.01);
    EXPECT_GT(toe_tension.high, 100.0);
}

double reference_N_per_m(const Recording& recording) {
    return the_one(candidate_causes(recording), "load_dependent_friction").given.front().value;
}

// The law of friction is limited to a range about its reference, which must lie where the cables work.
TEST(CandidateCauses, ReferToTheTensionOfADriveWithoutPretensionByItsTorques) {
    Recording recording = driven_session();
    const double taut_N_per_m = reference_N_per_m(recording);
    for (RecordedRun& run : recording.runs) *run.pretension_N *= 2.0;
    EXPECT_DOUBLE_EQ(reference_N_per_m(recording), 2.0 * taut_N_per_m) << "of a taut pair by its pretension";
    for (RecordedRun& run : recording.runs) run.pretension_N = 1e-3;
    const double slack_N_per_m = reference_N_per_m(recording);
    EXPECT_GT(slack_N_per_m, 0.1 * taut_N_per_m);
    const auto load_torque = static_cast<std::size_t>(*recording.channel("load_torque"));
    const auto motor_torque = static_cast<std::size_t>(*recording.channel("motor_torque"));
    for (RecordedRun& run : recording.runs) {
        for (const std::size_t channel : {load_torque, motor_torque})
            for (double& value : run.values[channel]) value *= 3.0;
    }
    EXPECT_NEAR(reference_N_per_m(recording), 3.0 * slack_N_per_m, 1e-9 * slack_N_per_m);
}

TEST(CandidateCauses, TheLoopOfASensorHasASizeAndAShape) {
    const std::vector<CandidateCause> causes = candidate_causes(driven_session());
    const auto loop = std::find_if(causes.begin(), causes.end(), [](const CandidateCause& cause) {
        return cause.effect == "sensor_hysteresis" && cause.variant == "load_torque";
    });
    ASSERT_NE(loop, causes.end());
    ASSERT_EQ(loop->numbers.size(), 2u);
    EXPECT_EQ(loop->numbers[1].value(0.0), SensorFaults().loop_exponent);
    BenchNumbers numbers;
    loop->apply(numbers, std::vector<double>{0.2, 0.7});
    EXPECT_EQ(numbers.sensor_faults["load_torque"].hysteresis, 0.2);
    EXPECT_EQ(numbers.sensor_faults["load_torque"].loop_exponent, 0.7);
}

TEST(CandidateCauses, PreslidingHasALengthAndAnExponent) {
    const std::vector<CandidateCause> causes = candidate_causes(driven_session());
    const auto presliding = std::find_if(causes.begin(), causes.end(), [](const CandidateCause& cause) {
        return cause.effect == "presliding";
    });
    ASSERT_NE(presliding, causes.end());
    ASSERT_EQ(presliding->numbers.size(), 2u);
    EXPECT_EQ(presliding->numbers[1].kind, OpenNumber::Kind::shape);
    BenchNumbers numbers;
    presliding->apply(numbers, std::vector<double>{2e-4, 0.7});
    EXPECT_EQ(numbers.effects.of<Presliding>().length_m, 2e-4);
    EXPECT_EQ(numbers.effects.of<Presliding>().exponent, 0.7);
}

TEST(CandidateCauses, AreSeenWhereAChannelsValuesLieOnALattice) {
    Recording recording = driven_session();
    const auto load_torque = static_cast<std::size_t>(*recording.channel("load_torque"));
    for (RecordedRun& run : recording.runs) {
        run.values[load_torque].clear();
        for (const double time_s : run.time_s)
            run.values[load_torque].push_back(0.07 * std::round(std::sin(time_s) / 0.07));
    }
    int seen = 0;
    for (const CandidateCause& cause : candidate_causes(recording)) {
        EXPECT_EQ(cause.is_seen, cause.effect == "sensor_quantization");
        seen += cause.is_seen ? 1 : 0;
    }
    EXPECT_EQ(seen, 1);
}

}  // namespace
}  // namespace capstan::gap
