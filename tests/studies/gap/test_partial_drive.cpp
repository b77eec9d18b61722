#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capstan/cable/invalid_input.h"
#include "capstan/gap/bench_knowledge.h"
#include "capstan/gap/cause_fit.h"
#include "capstan/gap/cause_search.h"
#include "capstan/gap/equivalent_bench.h"
#include "lumped_session.h"
#include "sample_recording.h"

namespace capstan::gap {
namespace {

Recording without(Recording recording, const std::string& name) {
    const auto at = static_cast<std::ptrdiff_t>(*recording.channel(name));
    recording.channels.erase(recording.channels.begin() + at);
    for (RecordedRun& run : recording.runs) {
        run.values.erase(run.values.begin() + at);
        std::erase(run.driven, name);
    }
    return recording;
}

// A motor that turns a pair whose load pulley is held by a spring; only the two angles are recorded.
Recording motion_session() {
    constexpr double sample_rate_Hz = 50.0;
    constexpr int samples = 200;
    CableSpecification cable;
    cable.curvature = {{1.0, 1.0}};
    cable.segments = 40;
    cable.axial_stiffness_N = 3.0;
    cable.dynamic_friction = cable.static_friction = 0.4;
    cable.pretension_N = 0.5;
    const PullPull pair{Cable(cable), Cable(cable), {1.0, 1.5}};
    Recording recording;
    recording.name = "catheter";
    recording.mode = BenchMode::lumped_drive;
    recording.sample_rate_Hz = sample_rate_Hz;
    recording.channels = {{"motor_angle", "rad", {}, {}}, {"load_angle", "rad", {}, {}}};
    for (const double amplitude_rad : {0.6, 0.4}) {
        RecordedRun run;
        run.number = static_cast<int>(recording.runs.size()) + 1;
        run.driven = {"motor_angle"};
        run.values.resize(2);
        PullPullState state = pair.at_rest();
        for (int sample = 0; sample < samples; ++sample) {
            const double time_s = sample / sample_rate_Hz;
            const double angle_rad = amplitude_rad * std::sin(2.0 * std::numbers::pi * time_s);
            pair.advance(state, {MotorAngle{angle_rad}, LoadSpring{0.6, 0.0}});
            run.time_s.push_back(time_s);
            run.values[0].push_back(angle_rad);
            run.values[1].push_back(0.2 + state.load_angle_rad);
        }
        recording.runs.push_back(run);
    }
    return recording;
}

// The tension at the held end of a cable whose other end is pulled stays where friction lets it (E1): between
// T exp(-phi) and T exp(phi).
Recording tension_session(double exponent) {
    Recording recording;
    recording.name = "sheath";
    recording.mode = BenchMode::capstan_band;
    recording.sample_rate_Hz = 50.0;
    recording.channels = {{"tension_1", "N", {}, {}}, {"tension_2", "N", {}, {}}};
    RecordedRun run;
    run.number = 1;
    run.driven = {"tension_1"};
    run.pretension_N = 10.0;
    run.values.resize(2);
    double held_N = 10.0;
    for (int sample = 0; sample < 300; ++sample) {
        const double time_s = sample / 50.0;
        const double pulled_N = 10.0 + 6.0 * std::sin(2.0 * std::numbers::pi * 0.5 * time_s);
        held_N = std::clamp(held_N, pulled_N * std::exp(-exponent), pulled_N * std::exp(exponent));
        run.time_s.push_back(time_s);
        run.values[0].push_back(pulled_N);
        run.values[1].push_back(held_N);
    }
    recording.runs.push_back(run);
    return recording;
}

// A load cell is made for the whole load that it carries, and so is its zero.
TEST(PartialDrive, TheZeroOfALoadCellGoesWithItsLoadHoweverLittleThatVaries) {
    const auto zero_of_a_cable_under = [](double tension_N) {
        Recording recording = tension_session(0.3);
        for (double& each_N : recording.runs.front().values[1]) each_N += tension_N - 10.0;
        NominalBench bench;
        bench.curvature = {{1.0, 0.5}};
        recording.nominal = bench;
        for (const FloatingNumber& number : built_bench(recording).numbers) {
            if (number.name == "zero of tension_2") return number.prior_std * number.scale;
        }
        return 0.0;
    };
    const double usual_N = zero_of_a_cable_under(10.0);
    EXPECT_GT(usual_N, 0.0);
    EXPECT_NEAR(zero_of_a_cable_under(1000.0) / usual_N, 1000.0 / 13.0, 15.0);
}

// What the fitted bench leaves of a channel: rms over its span.
double left_fraction(const Recording& bench, const std::string& name) {
    const BenchKnowledge knowledge = undescribed_bench(bench);
    const CauseFitter fitter(bench, {}, 1);
    const CauseFit fit = fitter.fit(nominal_hypothesis(knowledge), {});
    const auto channel = static_cast<std::size_t>(*bench.channel(name));
    double squares = 0.0;
    double rows = 0.0;
    double span = 0.0;
    for (const ResidualSeries& series : fitter.series()) {
        if (series.channel != channel) continue;
        const auto residuals = fit.residuals.segment(static_cast<Eigen::Index>(series.first_row),
                                                     static_cast<Eigen::Index>(series.rows));
        squares += residuals.squaredNorm() * series.scale * series.scale;
        rows += static_cast<double>(series.rows);
        const auto& values = bench.runs[series.run].values[channel];
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        span = std::max(span, *high - *low);
    }
    return std::sqrt(squares / rows) / span;
}

TEST(PartialDrive, OfTwoAnglesIsHeldByASpringThatIsFitted) {
    const Recording bench = equivalent_bench(motion_session(), motion_session());
    EXPECT_EQ(bench.mode, BenchMode::pull_pull);
    EXPECT_EQ(bench.runs[0].driven, std::vector<std::string>{"motor_angle"});
    EXPECT_GT(bench.nominal->load_compliance_rad_per_Nm, 0.0);
    EXPECT_LT(left_fraction(bench, "load_angle"), 0.02);
}

TEST(PartialDrive, WithoutALoadTorqueTheMotorTorqueIsStillPredicted) {
    const Recording recording = without(lumped_session({}), "load_torque");
    const Recording bench = equivalent_bench(recording, recording);
    EXPECT_TRUE(bench.is_predicted("motor_torque"));
    EXPECT_TRUE(bench.is_predicted("load_angle"));
}

TEST(PartialDrive, OfTwoTorquesIsHeldAtItsLoad) {
    const Recording recording = without(without(lumped_session({}), "motor_angle"), "load_angle");
    const Recording bench = equivalent_bench(recording, recording);
    EXPECT_EQ(bench.runs[0].driven, (std::vector<std::string>{"motor_torque", "load_angle"}));
    EXPECT_TRUE(bench.is_predicted("load_torque"));
}

TEST(PartialDrive, OfACurrentHasItsTorqueConstant) {
    constexpr double constant_Nm_per_A = 0.05;
    Recording recording = lumped_session({});
    recording.channels[0] = {"motor_current", "A", {}, {}};
    for (RecordedRun& run : recording.runs)
        for (double& value : run.values[0]) value /= constant_Nm_per_A;
    const Recording bench = equivalent_bench(recording, recording);
    EXPECT_NEAR(bench.nominal->torque_constant_Nm_per_A, constant_Nm_per_A, 0.1 * constant_Nm_per_A);
    EXPECT_LT(left_fraction(bench, "motor_torque"), 0.03);
}

TEST(PartialDrive, OfOneChannelIsRejected) {
    Recording recording = without(without(lumped_session({}), "load_torque"), "load_angle");
    EXPECT_NO_THROW(equivalent_bench(recording, recording));
    recording = without(recording, "motor_torque");
    EXPECT_THROW(equivalent_bench(recording, recording), InvalidInput);
}

TEST(BandWithoutMotion, HasTheFrictionThatItsTensionsShow) {
    constexpr double exponent = 0.35;
    const Recording recording = tension_session(exponent);
    const Recording bench = equivalent_bench(recording, recording);
    EXPECT_EQ(bench.mode, BenchMode::single_cable);
    EXPECT_NEAR(bench.nominal->dynamic_friction, exponent, 0.05 * exponent);
    EXPECT_LT(left_fraction(bench, "load_torque"), 0.02);
}

// The few segments that are enough for a drive would differ by more than noise and floor, which a search
// would fit.
TEST(BandWithoutMotion, IsSearchedWithAModelThatAgreesWithTheFineOne) {
    const Recording recording = tension_session(0.35);
    const Recording bench = equivalent_bench(recording, recording);
    const CauseSearch search(bench, {});
    const BenchKnowledge knowledge = undescribed_bench(bench);
    const Hypothesis nominal = nominal_hypothesis(knowledge);
    const Eigen::MatrixXd fine = search.fitter().data_residuals({&nominal, 1});
    const Eigen::MatrixXd coarse = search.coarse_fitter().data_residuals({&nominal, 1});
    ASSERT_EQ(fine.rows(), coarse.rows());
    const double rms = (coarse - fine).norm() / std::sqrt(static_cast<double>(fine.rows()));
    EXPECT_LT(rms, 0.5) << "of noise and floor";
}

// A torque sensor that reads 0.2 N m too much drives the bench with 0.2 N m less than it reads.
TEST(EffectsTwin, APrescribedTorqueIsLessByItsSensorsZero) {
    constexpr double zero_Nm = 0.2;
    const Recording recording = driven_session();
    Recording shifted = recording;
    const auto torque = static_cast<std::size_t>(*recording.channel("motor_torque"));
    ASSERT_TRUE(recording.runs[0].drives("motor_torque"));
    for (RecordedRun& run : shifted.runs)
        for (double& value : run.values[torque]) value += zero_Nm;
    BenchNumbers numbers;
    numbers.sensor_faults["motor_torque"].offset = zero_Nm;
    const TwinRun as_read = EffectsTwin(shifted, {}).run(0, numbers);
    const TwinRun as_it_acts = EffectsTwin(recording, {}).run(0, {});
    for (std::size_t channel = 0; channel < as_read.values.size(); ++channel) {
        ASSERT_EQ(as_read.values[channel].size(), as_it_acts.values[channel].size());
        for (std::size_t sample = 0; sample < as_read.values[channel].size(); ++sample)
            EXPECT_NEAR(as_read.values[channel][sample], as_it_acts.values[channel][sample], 1e-6);
    }
}

}  // namespace
}  // namespace capstan::gap
