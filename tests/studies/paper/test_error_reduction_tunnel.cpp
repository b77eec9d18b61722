#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "capstan/paper/error_reduction_tunnel.h"

namespace capstan::paper {
namespace {

const CableSetting& reproducing() {
    return cable_settings().back();
}

const std::vector<TunnelRun>& reproducing_runs() {
    static const std::vector<TunnelRun> runs = [] {
        std::vector<TunnelRun> all;
        for (const double pretension_N : reproducing().pretensions_N) {
            all.push_back(run_error_reduction_tunnel(reproducing(), pretension_N, {}));
        }
        return all;
    }();
    return runs;
}

TEST(ErrorReductionTunnel, TheMotorDrivesBackFromOutsideTheTunnelOnly) {
    EXPECT_EQ(tunnel_torque_Nm(0.0), 0.0);
    EXPECT_EQ(tunnel_torque_Nm(0.05), 0.0);
    EXPECT_EQ(tunnel_torque_Nm(-0.05), 0.0);
    EXPECT_DOUBLE_EQ(tunnel_torque_Nm(0.25), -0.1);
    EXPECT_DOUBLE_EQ(tunnel_torque_Nm(-0.25), 0.1);
    EXPECT_DOUBLE_EQ(tunnel_torque_Nm(2.0), -0.2) << "ends at 0.2 N m";
    EXPECT_DOUBLE_EQ(tunnel_torque_Nm(-2.0), 0.2);
}

TEST(ErrorReductionTunnel, TheHandMovesFortyDegreesAndRepeats) {
    double low_rad = 0.0;
    double high_rad = 0.0;
    for (double time_s = 0.0; time_s < handle_period_s; time_s += 0.001) {
        low_rad = std::min(low_rad, handle_angle_rad(time_s));
        high_rad = std::max(high_rad, handle_angle_rad(time_s));
    }
    EXPECT_NEAR((high_rad - low_rad) * 180.0 / std::numbers::pi, 40.0, 0.1);
    EXPECT_EQ(handle_angle_rad(0.0), 0.0);
    EXPECT_NEAR(handle_angle_rad(3.3 + handle_period_s), handle_angle_rad(3.3), 1e-12);
}

TEST(ErrorReductionTunnel, EveryStepIsSolved) {
    for (const TunnelRun& run : reproducing_runs()) EXPECT_EQ(run.unsolved_steps, 0) << run.pretension_N;
}

// The independent prototype's range, 15% below the paper's bench.
TEST(ErrorReductionTunnel, ThePeakIsTwiceTheIdealsAndNearThePapers) {
    for (const TunnelRun& run : reproducing_runs()) {
        EXPECT_NEAR(run.peak_load_torque_Nm, 1.5, 0.15) << run.pretension_N;
        EXPECT_NEAR(run.ideal_peak_load_torque_Nm, 5.2 * 0.5 * (20.0 * std::numbers::pi / 180.0 - 0.05),
                    0.002);
    }
}

TEST(ErrorReductionTunnel, FrictionLoopTakesMoreWorkAtHigherPretension) {
    double before_J = 0.0;
    for (const TunnelRun& run : reproducing_runs()) {
        EXPECT_GT(run.loop_work_J, 0.5) << run.pretension_N;
        EXPECT_GT(run.dissipated_J, before_J) << run.pretension_N;
        before_J = run.dissipated_J;
    }
}

// The hand pays: moving outward it meets more than the tunnel asks for, on the way back less.
TEST(ErrorReductionTunnel, FrictionOpposesTheHand) {
    for (const TunnelRun& run : reproducing_runs()) {
        int opposed = 0;
        int moving = 0;
        for (std::size_t k = 1; k < run.samples.size(); ++k) {
            const double moved_rad = run.samples[k].load_angle_rad - run.samples[k - 1].load_angle_rad;
            const double friction_Nm = run.samples[k].load_torque_Nm - run.samples[k].ideal_load_torque_Nm;
            if (std::abs(moved_rad) < 0.001) continue;  // about to turn back
            ++moving;
            if (friction_Nm * moved_rad < 0.0) ++opposed;
        }
        EXPECT_GT(opposed, 0.95 * moving) << run.pretension_N;
    }
}

TEST(ErrorReductionTunnel, HasConvergedInSegmentsAndSteps) {
    const TunnelRun& usual = reproducing_runs().back();
    for (const Resolution& finer : {Resolution{200, 0.005}, Resolution{100, 0.0025}}) {
        const TunnelRun run = run_error_reduction_tunnel(reproducing(), usual.pretension_N, finer);
        EXPECT_NEAR(run.peak_load_torque_Nm, usual.peak_load_torque_Nm, 0.005);
        EXPECT_NEAR(run.rms_to_ideal_Nm, usual.rms_to_ideal_Nm, 0.005);
        EXPECT_NEAR(run.dissipated_J, usual.dissipated_J, 0.01 * usual.dissipated_J);
    }
}

}  // namespace
}  // namespace capstan::paper
