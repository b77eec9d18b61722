#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capstan/cable/cable_cut.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/estimate/modelled_cable.h"
#include "capstan/estimate/tracking.h"
#include "full_model.h"

namespace capstan::estimate {
namespace {

TEST(WithBend, AddsItsAngleAndKeepsTheLength) {
    const std::vector<CurvaturePiece> path = {{0.5, straight}, {1.5, 0.6}};
    const std::vector<CurvaturePiece> bent = with_bend(path, 0.4, 0.7, 0.9);
    EXPECT_EQ(bent.size(), 4u);  // straight, bent, bent more, as before
    EXPECT_NEAR(length_m(bent), 2.0, 1e-12);
    EXPECT_NEAR(wrap_rad(bent), wrap_rad(path) + 0.9, 1e-12);
}

TEST(WithBend, LeavesOutWhatLiesBeyondTheEnd) {
    const std::vector<CurvaturePiece> bent = with_bend({{1.0, straight}}, -0.1, 0.1, 1.0);
    EXPECT_NEAR(length_m(bent), 1.0, 1e-12);
    EXPECT_NEAR(wrap_rad(bent), 0.5, 1e-12);
}

class ModelledCable : public testing::Test {
  protected:
    const bench_model::BenchModel model = bench_model::full_model();
    const Recording recording = gap::exact_session({}, gap::coarse_twin);
    const ModelledCables modelled = modelled_cables(recording, model, 20);
    const std::vector<SensedCable> nominal = sensed_cables(recording, 20);
};

TEST_F(ModelledCable, HasTheModelsNumbers) {
    ASSERT_EQ(modelled.cables.size(), 1u);  // only cable B carries a sensor
    const SensedCable& cable = modelled.cables[0];
    EXPECT_EQ(cable.specification.axial_stiffness_N,
              nominal[0].specification.axial_stiffness_N * model.stiffness_ratio.value);
    EXPECT_NEAR(cable.runs[1].pretension_N, nominal[0].runs[1].pretension_N * model.pretension_ratio.value,
                1e-12);
    EXPECT_EQ(cable.runs[0].friction_ratio, model.friction_ratio.value);
    const double bend_rad = model.numbers().effects.of<LocalBend>().extra_angle_rad;
    EXPECT_NEAR(wrap_rad(cable.specification.curvature),
                wrap_rad(nominal[0].specification.curvature) + bend_rad, 1e-9);
}

TEST_F(ModelledCable, IsUncertainWhereTheModelHasAnInterval) {
    ASSERT_EQ(modelled.cables[0].uncertain.size(), 1u);  // of friction alone
    const gap::FittedInterval& interval = *model.friction_ratio.interval;
    EXPECT_NEAR(std::log(modelled.cables[0].uncertain[0].friction_ratio),
                std::log(interval.high / interval.low) / (2.0 * 1.96), 1e-4);
}

TEST_F(ModelledCable, NamesWhatTheEstimatorCannotUse) {
    EXPECT_EQ(modelled.not_used,
              (std::vector<std::string>{"pulley friction", "sensor hysteresis (load torque)"}));
    EXPECT_EQ(modelled.cables[0].rate_friction.viscous.drag_N_s_per_m2,
              model.numbers().effects.of<ViscousFriction>().drag_N_s_per_m2);
}

TEST_F(ModelledCable, ReadsItsSensorsWithoutTheirZeroAndGain) {
    bench_model::BenchModel faulty = model;
    faulty.sensors = {{"tension_1", {{"offset", "N", 2.0}, {"gain", "", 0.5}, {"lag", "s", 0.1}}},
                      {"load_torque", {{"time_misalignment", "s", 0.5 / recording.sample_rate_Hz}}}};
    const ModelledCables read = modelled_cables(recording, faulty, 20);
    for (std::size_t k = 0; k < 10; ++k)
        EXPECT_NEAR(read.cables[0].runs[0].reading_N[0][k], (nominal[0].runs[0].reading_N[0][k] - 2.0) / 0.5,
                    1e-9);
    EXPECT_NEAR(read.cables[0].channels[0].noise_N, nominal[0].channels[0].noise_N / 0.5, 1e-12);
    EXPECT_EQ(read.not_used.back(), "sensor lag (tension 1)");
}

TEST_F(ModelledCable, OfUnknownGeometryIsRejected) {
    bench_model::BenchModel unknown = model;
    unknown.recorded_mode = BenchMode::lumped_drive;
    EXPECT_THROW(modelled_cables(recording, unknown, 20), InvalidInput);
}

// The band without readings is then that of the model's numbers: what a cable with a number off carries, by
// its definition.
TEST_F(ModelledCable, HasABandAsWideAsItsNumbersLeaveOpen) {
    SensedCable cable = modelled.cables[0];
    cable.uncertain = {{.friction_ratio = 1.1}, {.pretension_ratio = 0.95}};
    std::vector<SensedCable> alone = {cable, cable, cable};
    alone[1].specification.dynamic_friction *= 1.1;
    alone[1].specification.static_friction *= 1.1;
    std::vector<std::vector<double>> mean_N(3);
    std::vector<double> deviation_N;
    for (std::size_t k = 0; k < 2; ++k) {
        alone[k].uncertain.clear();
        track(alone[k], {}, {}, {}, [&](const TrackedSample& at) {
            mean_N[k].push_back(at.at_node(5).mean_N);
            EXPECT_LT(at.at_node(5).deviation_N, 1e-9);
        });
    }
    std::size_t sample = 0;
    bool is_wider_somewhere = false;
    track(cable, {}, {}, {}, [&](const TrackedSample& at) {
        const RecursiveEstimator::Moments moments = at.at_node(5);
        const double of_friction_N = std::abs(mean_N[1][sample] - mean_N[0][sample]);
        EXPECT_EQ(moments.mean_N, mean_N[0][sample]);
        EXPECT_GE(moments.deviation_N, of_friction_N - 1e-9);
        is_wider_somewhere = is_wider_somewhere || moments.deviation_N > of_friction_N + 0.01;
        ++sample;
    });
    EXPECT_TRUE(is_wider_somewhere);
}

}  // namespace
}  // namespace capstan::estimate
