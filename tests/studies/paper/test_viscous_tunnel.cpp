#include <gtest/gtest.h>

#include <cmath>

#include "capstan/paper/error_reduction_tunnel.h"
#include "capstan/paper/viscous_tunnel.h"

namespace capstan::paper {
namespace {

ViscousComparison compared(const ViscousBench& bench) {
    const CableSetting& setting = cable_settings().back();
    return compare_viscous_models(setting, setting.pretensions_N.back(), bench, {});
}

const ViscousComparison& usual() {
    static const ViscousComparison comparison = compared({});
    return comparison;
}

// The simulation with effects has friction at the nodes, the closed form along segments.
TEST(ViscousTunnel, WithoutTheTermTheModelIsThatOfTheTunnel) {
    const CableSetting& setting = cable_settings().back();
    const TunnelRun closed_form = run_error_reduction_tunnel(setting, setting.pretensions_N.back(), {});
    ASSERT_EQ(closed_form.samples.size(), usual().samples.size());
    double squares = 0.0;
    for (std::size_t k = 0; k < closed_form.samples.size(); ++k)
        squares += std::pow(closed_form.samples[k].load_torque_Nm - usual().samples[k].without_term_Nm, 2);
    EXPECT_LT(std::sqrt(squares / closed_form.samples.size()), 0.005) << "of a peak of 1.4 N m";
}

// The two numbers of the paper that the simulated bench was made for.
TEST(ViscousTunnel, TheTermExplainsAboutHalfOfThePapersResidual) {
    EXPECT_NEAR(usual().without_term.rms_Nm, PaperViscous{}.rms_without_term_Nm, 0.01);
    EXPECT_NEAR(usual().reduction(), PaperViscous{}.reduction, 0.03);
}

TEST(ViscousTunnel, TheTermRemovesTheSlopeOverVelocity) {
    EXPECT_LT(usual().without_term.slope_Nm_s_per_rad, -0.1) << "drag opposes the hand";
    EXPECT_LT(std::abs(usual().with_term.slope_Nm_s_per_rad),
              0.05 * std::abs(usual().without_term.slope_Nm_s_per_rad));
}

TEST(ViscousTunnel, WithoutOtherErrorsTheFitFindsTheDragAndLeavesTheNoise) {
    ViscousBench bench;
    bench.remainder = 0.0;
    bench.load_friction_Nm = 0.0;
    const ViscousComparison clean = compared(bench);
    EXPECT_NEAR(clean.fitted_drag_N_s_per_m2, bench.drag_N_s_per_m2, 0.02 * bench.drag_N_s_per_m2);
    EXPECT_NEAR(clean.with_term.rms_Nm, bench.torque_noise_Nm, 0.1 * bench.torque_noise_Nm);
}

TEST(ViscousTunnel, UnmodelledPulleyFrictionIsFittedAsDrag) {
    EXPECT_GT(usual().fitted_drag_N_s_per_m2, usual().bench.drag_N_s_per_m2 + 1.0);
}

TEST(ViscousTunnel, NearlyEveryStepIsSolved) {
    EXPECT_LT(usual().unsolved_steps, usual().samples.size() / 500);
}

}  // namespace
}  // namespace capstan::paper
