#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "capstan/cable/cable_cut.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/ensemble/ensemble_filter.h"
#include "capstan/sensing/random_stream.h"
#include "capstan/solver/quasi_static_step.h"

namespace capstan {
namespace {

constexpr double interval_s = 0.01;
constexpr int samples = 200;

CableSpecification arm() {
    return {.curvature = {{0.3, straight}, {0.2, 0.12}, {0.3, straight}, {0.15, 0.08}, {0.25, straight}},
            .segments = 12,
            .axial_stiffness_N = 9000.0,
            .dynamic_friction = 0.12,
            .static_friction = 0.16,
            .pretension_N = 15.0};
}

double motor_m(int sample) {
    return 0.002 * std::sin(2.0 * std::numbers::pi * 0.7 * sample * interval_s);
}

std::vector<SensorOffer> two_sensors(double noise_N) {
    SensorErrors errors;
    errors.additive = noise_N;
    return {{SensorKind::tension, 0.0, errors}, {SensorKind::tension, 1.2, errors}};
}

void expect_the_cable_of(const CableSpecification& specification) {
    const UncertainCable cable(specification);
    CableBelief belief;
    belief.interval_s = interval_s;
    const EnsembleDraws draws({1, 0}, 16, 3 + cable.bends(), 0, samples);
    EnsembleFilter filter(cable, belief, {}, {}, draws);
    const QuasiStaticStep step(Cable(specification), ModelRules::consistent());
    CableState state = pretensioned(step.cable());
    const double rest_m = state.displacement_m.front();
    for (int n = 1; n <= samples; ++n) {
        step.advance(state, {EndCondition::position_m(rest_m + motor_m(n)), EndCondition::position_m(0.0)});
        filter.step(motor_m(n) - motor_m(n - 1), {});
        for (int node = 0; node < step.cable().nodes(); ++node) {
            ASSERT_NEAR(filter.mean_N()[node], state.tension_N[node], 1e-6) << "sample " << n;
            ASSERT_LT(filter.deviation_N()[node], 1e-6);
        }
    }
}

TEST(EnsembleFilter, FollowsTheCableExactlyWhereEverythingIsKnown) {
    expect_the_cable_of(arm());
    CableSpecification at_bends = arm();
    at_bends.node_places_m = bend_ends_m(at_bends.curvature);
    at_bends.node_places_m.push_back(1.1);
    expect_the_cable_of(at_bends);
}

// A second sensor at the other end tells a wrong friction from a moved end.
TEST(EnsembleFilter, LearnsTheFrictionFromSensorsAtBothEnds) {
    const UncertainCable cable(arm());
    CableFactors factors{
        .log_friction = 0.25, .log_stiffness = 0.0, .log_pretension = 0.0, .log_wrap = {0.0, 0.0}};
    const QuasiStaticStep truth(Cable(cable.with(factors)), ModelRules::consistent());
    CableBelief belief;
    belief.interval_s = interval_s;
    belief.uncertainty = {.friction = 0.2};
    belief.far_end = {.range_m = 0.001};
    const std::vector<SensorOffer> offers = two_sensors(0.05);
    const EnsembleDraws draws({1, 0}, 64, 3 + cable.bends(), 2, samples);
    const int used[] = {0, 1};
    EnsembleFilter filter(cable, belief, offers, used, draws);
    EXPECT_NEAR(filter.log_friction().mean, 0.0, 1e-12);
    CableState state = pretensioned(truth.cable());
    const double rest_m = state.displacement_m.front();
    for (int n = 1; n <= samples; ++n) {
        truth.advance(state, {EndCondition::position_m(rest_m + motor_m(n)), EndCondition::position_m(0.0)});
        const auto noise =
            standard_normals({7, RandomPurpose::reading_noise, 0, static_cast<std::uint32_t>(n), 0});
        const double readings[] = {state.tension_N.front() + 0.05 * noise[0],
                                   state.tension_N.back() + 0.05 * noise[1]};
        filter.step(motor_m(n) - motor_m(n - 1), readings);
    }
    EXPECT_NEAR(filter.log_friction().mean, 0.25, 0.06);
    EXPECT_LT(filter.log_friction().deviation, 0.08);
}

// Slack members all read 0. The motor rests, so only the far end can have pulled the cable taut.
TEST(EnsembleFilter, FindsACableAgainThatBecameTautWhileEveryMemberIsSlack) {
    const UncertainCable cable(arm());
    CableBelief belief;
    belief.interval_s = interval_s;
    belief.uncertainty = {.pretension = 0.05};
    belief.far_end = {.range_m = 0.0005};
    SensorErrors errors{.additive = 0.1, .zero = 0.2};
    const std::vector<SensorOffer> offers = {{SensorKind::tension, 0.0, errors},
                                             {SensorKind::motor_torque, 0.0, errors}};
    for (const int sensor : {0, 1}) {
        const EnsembleDraws draws({1, 0}, 64, 3 + cable.bends(), 2, samples);
        const int used[] = {sensor};
        EnsembleFilter filter(cable, belief, offers, used, draws);
        const double slack_N[] = {0.0};
        for (int n = 0; n < 20; ++n) filter.step(0.0003, slack_N);  // 6 mm, where 2 mm take up the pretension
        ASSERT_EQ(filter.mean_N().front(), 0.0);
        const double taut_N[] = {5.0};
        for (int n = 0; n < 20; ++n) filter.step(0.0, taut_N);
        EXPECT_NEAR(filter.mean_N().front(), 5.0, 0.5) << "sensor " << sensor;
    }
}

TEST(EnsembleFilter, AnEncoderAtTheLoadTellsWhereTheFarEndIs) {
    const UncertainCable cable(arm());
    CableBelief belief;
    belief.interval_s = interval_s;
    belief.far_end = {.range_m = 0.002};
    SensorErrors errors;
    errors.additive = 1e-5;
    const std::vector<SensorOffer> offers = {{SensorKind::load_displacement, 1.2, errors}};
    const EnsembleDraws draws({1, 0}, 32, 3 + cable.bends(), 1, samples);
    const int used[] = {0};
    EnsembleFilter filter(cable, belief, offers, used, draws);
    for (int n = 1; n <= samples; ++n) {
        const double moved_m[] = {0.0005 * std::sin(2.0 * std::numbers::pi * n * interval_s)};
        filter.step(motor_m(n) - motor_m(n - 1), moved_m);
        if (n > 20) {
            ASSERT_NEAR(filter.far_end_m().mean, moved_m[0], 5e-5) << "sample " << n;
        }
    }
}

TEST(EnsembleFilter, NeverSaysThatTheCablePushes) {
    const UncertainCable cable(arm());
    CableBelief belief;
    belief.interval_s = interval_s;
    belief.uncertainty = {.friction = 0.1, .stiffness = 0.05, .pretension = 0.1, .wrap = 0.05};
    belief.far_end = {.range_m = 0.01};  // slack now and then
    const std::vector<SensorOffer> offers = two_sensors(0.5);
    const EnsembleDraws draws({3, 0}, 32, 3 + cable.bends(), 2, samples);
    const int used[] = {0, 1};
    EnsembleFilter filter(cable, belief, offers, used, draws);
    for (int n = 1; n <= samples; ++n) {
        const double readings[] = {0.0, 0.0};
        filter.step(n < 100 ? 1e-4 : -1e-4, readings);
        for (const double tension_N : filter.mean_N()) {
            ASSERT_GE(tension_N, 0.0);
            ASSERT_TRUE(std::isfinite(tension_N));
        }
    }
}

TEST(EnsembleFilter, RefusesInputThatIsNotFiniteAndSensorsBeyondTheCable) {
    const UncertainCable cable(arm());
    const EnsembleDraws draws({1, 0}, 16, 3 + cable.bends(), 1, 1);
    const std::vector<SensorOffer> beyond = {{SensorKind::tension, 1.3, {}}};
    const int used[] = {0};
    EXPECT_THROW(EnsembleFilter(cable, {}, beyond, used, draws), InvalidInput);
    EnsembleFilter filter(cable, {}, {}, {}, draws);
    EXPECT_THROW(filter.step(std::nan(""), {}), InvalidInput);
    filter.step(0.0, {});
    EXPECT_THROW(filter.step(0.0, {}), InvalidInput);  // there are draws for one sample only
}

TEST(FarEndProcess, StaysWithinItsRangeNinetyFivePercentOfTheTime) {
    const FarEndProcess process({.range_m = 0.001, .bandwidth_Hz = 2.0}, interval_s);
    double y = 0.0;
    double v = 0.0;
    int within = 0;
    constexpr int steps = 200000;
    for (int n = 0; n < steps; ++n) {
        const auto normals =
            standard_normals({5, RandomPurpose::world_far_end, static_cast<std::uint32_t>(n), 0, 0});
        process.advance(y, v, normals[0], normals[1]);
        within += std::abs(y) <= 0.001 ? 1 : 0;
    }
    // Some 2 Hz of bandwidth over 2000 s: thousands of independent values, so 0.5% is two standard errors.
    EXPECT_NEAR(within / static_cast<double>(steps), 0.95, 0.006);
}

// Two half steps without noise are one step: the process does not depend on the sampling.
TEST(FarEndProcess, ForgetsAtTheSameRateForEverySampling) {
    const FarEndMotion motion{.range_m = 0.001, .bandwidth_Hz = 1.0};
    const FarEndProcess coarse(motion, 0.02);
    const FarEndProcess fine(motion, 0.01);
    double y = 1e-3, v = -2e-3, y_fine = y, v_fine = v;
    coarse.advance(y, v, 0.0, 0.0);
    fine.advance(y_fine, v_fine, 0.0, 0.0);
    fine.advance(y_fine, v_fine, 0.0, 0.0);
    EXPECT_NEAR(y, y_fine, 1e-15);
    EXPECT_NEAR(v, v_fine, 1e-14);
}

TEST(EnsembleDraws, HaveNoChanceInTheirMeanAndVariance) {
    const EnsembleDraws draws({9, 4}, 32, 2, 1, 3);
    for (const auto row : {draws.parameter(0), draws.parameter(1), draws.zero(0), draws.gain(0),
                           draws.first(2), draws.second(1)}) {
        const RowMoments moments = moments_of_row(row);
        EXPECT_NEAR(moments.mean, 0.0, 1e-14);
        EXPECT_NEAR(moments.deviation, 1.0, 1e-13);
    }
}

TEST(UncertainCable, FactorsChangeWhatTheyName) {
    const UncertainCable cable(arm());
    ASSERT_EQ(cable.bends(), 2);
    const CableSpecification changed = cable.with({.log_friction = std::log(1.2),
                                                   .log_stiffness = std::log(0.9),
                                                   .log_pretension = std::log(2.0),
                                                   .log_wrap = {0.0, std::log(1.5)}});
    EXPECT_DOUBLE_EQ(changed.dynamic_friction, 0.12 * 1.2);
    EXPECT_DOUBLE_EQ(changed.static_friction, 0.16 * 1.2);
    EXPECT_DOUBLE_EQ(changed.axial_stiffness_N, 8100.0);
    EXPECT_DOUBLE_EQ(changed.pretension_N, 30.0);
    const Cable before(arm());
    const Cable after(changed);
    EXPECT_DOUBLE_EQ(after.wrap_angle_rad()[3], before.wrap_angle_rad()[3]);
    EXPECT_NEAR(after.wrap_angle_rad()[8], 1.5 * before.wrap_angle_rad()[8], 1e-12);
}

}  // namespace
}  // namespace capstan
