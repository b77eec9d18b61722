// Work put in at the ends = elastic energy stored + friction loss. With one elongation rule for all segments
// the balance is exact when tensions are taken at the middle of each step.
#include <gtest/gtest.h>

#include <cmath>

#include "example_cables.h"
#include "trajectories.h"

namespace capstan {
namespace {

double stored_J(const Cable& cable, const CableState& state) {
    double energy = 0.0;
    for (int i = 0; i < cable.segments(); ++i) {
        const double mean_N = 0.5 * (state.tension_N[i] + state.tension_N[i + 1]);
        energy += 0.5 * cable.segment_compliance_m_per_N() * mean_N * mean_N;
    }
    return energy;
}

struct StepWork {
    double input_J = 0.0;          // by both ends
    double friction_J = 0.0;       // all segments
    double worst_sliding_J = 0.0;  // the least that a sliding segment lost
};

StepWork work(const Cable& cable, const CableState& a, const CableState& b) {
    const auto mean_N = [&](int node) { return 0.5 * (a.tension_N[node] + b.tension_N[node]); };
    const auto moved_m = [&](int node) { return b.displacement_m[node] - a.displacement_m[node]; };
    const int last = cable.segments();
    StepWork result;
    result.input_J = mean_N(last) * moved_m(last) - mean_N(0) * moved_m(0);
    for (int i = 0; i < last; ++i) {
        const double loss_J = (mean_N(i + 1) - mean_N(i)) * 0.5 * (moved_m(i) + moved_m(i + 1));
        result.friction_J += loss_J;
        const bool slides_on =
            segment_direction(b.last_motion, i, last) != Direction::none &&
            segment_direction(b.last_motion, i, last) == segment_direction(a.last_motion, i, last);
        if (slides_on) result.worst_sliding_J = std::min(result.worst_sliding_J, loss_J);
    }
    return result;
}

TEST(Energy, InputIsStoredOrLostInEveryStep) {
    const Cable cable(test::routed_specification(12));
    const QuasiStaticStep step(cable, ModelRules::cured());
    CableState state = pretensioned(cable);
    const double rest_m = state.displacement_m.front();
    double input_J = 0.0;
    for (const auto& [proximal_m, distal_m] : test::both_ends_wander(3000, 2e-4, 5)) {
        const CableState before = state;
        step.advance(state,
                     {EndCondition::position_m(rest_m + proximal_m), EndCondition::position_m(distal_m)});
        const StepWork done = work(cable, before, state);
        const double balance_J =
            done.input_J - (stored_J(cable, state) - stored_J(cable, before)) - done.friction_J;
        input_J += std::abs(done.input_J);
        EXPECT_NEAR(balance_J, 0.0, 1e-9 * input_J);
    }
}

TEST(Energy, FrictionOfASlidingSegmentNeverCreatesEnergy) {
    const Cable cable(test::routed_specification(12));
    const QuasiStaticStep step(cable, ModelRules::cured());
    CableState state = pretensioned(cable);
    const double rest_m = state.displacement_m.front();
    for (const auto& [proximal_m, distal_m] : test::both_ends_wander(3000, 2e-4, 9)) {
        const CableState before = state;
        step.advance(state,
                     {EndCondition::position_m(rest_m + proximal_m), EndCondition::position_m(distal_m)});
        EXPECT_GE(work(cable, before, state).worst_sliding_J, -1e-15);
    }
}

class ClosedCycle : public testing::TestWithParam<double> {};  // amplitude [m]

TEST_P(ClosedCycle, LosesEnergyAndReturnsToItself) {
    const Cable cable = test::paper_cable(20);
    const QuasiStaticStep step(cable, ModelRules::cured());
    CableState state = pretensioned(cable);
    const auto cycle = test::sine_against_locked_end(cable, GetParam(), 400, 400);
    for (const EndConditions& ends : cycle) step.advance(state, ends);  // settle
    const CableState start = state;
    double lost_J = 0.0;
    for (const EndConditions& ends : cycle) {
        const CableState before = state;
        step.advance(state, ends);
        lost_J += work(cable, before, state).friction_J;
    }
    EXPECT_GT(lost_J, 0.0);
    for (int node = 0; node < cable.nodes(); ++node) {
        EXPECT_NEAR(state.tension_N[node], start.tension_N[node], 0.05) << "node " << node;
    }
}

INSTANTIATE_TEST_SUITE_P(PartialAndMass, ClosedCycle, testing::Values(0.001, 0.004, 0.008));

}  // namespace
}  // namespace capstan
