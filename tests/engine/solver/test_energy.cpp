// Work put in at the ends = elastic energy stored + friction loss, step by step (energy_account.h).
#include <gtest/gtest.h>

#include "energy_account.h"
#include "example_cables.h"
#include "trajectories.h"

namespace capstan {
namespace {

TEST(Energy, FrictionOfASlidingSegmentNeverCreatesEnergy) {
    for (const Cable& cable :
         {Cable(test::routed_specification(12)), Cable(test::unevenly_cut_specification())}) {
        const QuasiStaticStep step(cable, ModelRules::consistent());
        CableState state = pretensioned(cable);
        const double rest_m = state.displacement_m.front();
        for (const auto& [proximal_m, distal_m] : test::both_ends_wander(3000, 2e-4, 9)) {
            const CableState before = state;
            step.advance(state,
                         {EndCondition::position_m(rest_m + proximal_m), EndCondition::position_m(distal_m)});
            EXPECT_GE(test::account(cable, before, state).worst_sliding_J, -1e-15);
        }
    }
}

class ClosedCycle : public testing::TestWithParam<double> {};  // amplitude [m]

TEST_P(ClosedCycle, LosesEnergyAndReturnsToItself) {
    const Cable cable = test::paper_cable(20);
    const QuasiStaticStep step(cable, ModelRules::consistent());
    CableState state = pretensioned(cable);
    const auto cycle = test::sine_against_locked_end(cable, GetParam(), 400, 400);
    for (const EndConditions& ends : cycle) step.advance(state, ends);  // settle
    const CableState start = state;
    test::EnergyAccount sum;
    for (const EndConditions& ends : cycle) {
        const CableState before = state;
        step.advance(state, ends);
        sum += test::account(cable, before, state);
    }
    EXPECT_GT(sum.friction_J, 0.0);
    for (int node = 0; node < cable.nodes(); ++node) {
        EXPECT_NEAR(state.tension_N[node], start.tension_N[node], 0.05) << "node " << node;
    }
}

INSTANTIATE_TEST_SUITE_P(PartialAndMass, ClosedCycle, testing::Values(0.001, 0.004, 0.008));

}  // namespace
}  // namespace capstan
