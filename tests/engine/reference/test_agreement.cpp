#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "capstan/reference/band_lu.h"
#include "capstan/reference/generic_solver.h"
#include "capstan/reference/linear_assumed.h"
#include "capstan/solver/quasi_static_step.h"
#include "motions.h"

namespace capstan {
namespace {

// The paper's figure for "machine precision", Sec. III.B.
constexpr double agreement_N = 1e-9;

double difference_N(const CableState& a, const CableState& b) {
    double largest = 0.0;
    for (std::size_t node = 0; node < a.tension_N.size(); ++node) {
        largest = std::max(largest, std::abs(a.tension_N[node] - b.tension_N[node]));
    }
    return largest;
}

using Case = std::tuple<test::Motion, int>;

class Agreement : public testing::TestWithParam<Case> {
  protected:
    const test::Motion& motion() const { return std::get<0>(GetParam()); }
    Cable cable() const { return test::preloaded_cable(std::get<1>(GetParam()), motion().static_friction); }

    // Every step from the same state: calls check(before, ends, after).
    template <typename Check>
    void along_the_path(const Check& check) const {
        const QuasiStaticStep step(cable(), ModelRules::cured());
        CableState state = pretensioned(step.cable());
        for (const EndConditions& ends : motion().path) {
            const CableState before = state;
            ASSERT_TRUE(step.advance(state, ends).verified);
            check(before, ends, state);
        }
    }
};

TEST_P(Agreement, WithTheGenericSolverWhereverItConverges) {
    const reference::GenericSolver generic(cable());
    int steps = 0;
    int converged = 0;
    double largest_N = 0.0;
    along_the_path([&](const CableState& before, const EndConditions& ends, const CableState& after) {
        CableState state = before;
        ++steps;
        if (!generic.advance(state, ends).converged) return;
        ++converged;
        largest_N = std::max(largest_N, difference_N(state, after));
    });
    EXPECT_LT(largest_N, agreement_N);
    // A root finder may fail; a check that never bites is none.
    EXPECT_GE(converged, 0.95 * steps);
    RecordProperty("converged_steps", converged);
    RecordProperty("steps", steps);
    RecordProperty("largest_difference_N", std::to_string(largest_N));
}

TEST_P(Agreement, WithBandLuInEveryStep) {
    reference::BandLuSolver band(cable());
    along_the_path([&](const CableState& before, const EndConditions& ends, const CableState& after) {
        CableState state = before;
        ASSERT_TRUE(band.advance(state, ends).converged);
        ASSERT_LT(difference_N(state, after), agreement_N);
    });
}

TEST_P(Agreement, OfDenseAndBandedLinearAssumedSolver) {
    reference::BandLuSolver band(cable());
    reference::LinearAssumedSolver dense(cable());
    int steps = 0;
    along_the_path([&](const CableState& before, const EndConditions& ends, const CableState&) {
        if (++steps > 60) return;  // cubic in the segments
        CableState by_band = before;
        CableState by_dense = before;
        ASSERT_TRUE(band.advance(by_band, ends).converged);
        ASSERT_TRUE(dense.advance(by_dense, ends).converged);
        ASSERT_LT(difference_N(by_band, by_dense), agreement_N);
    });
}

TEST(Motions, CoverEveryKindOfMotionAndEveryPairOfEnds) {
    std::set<MotionKind> kinds;
    for (const test::Motion& motion : test::all_motions(250)) {
        const QuasiStaticStep step(test::preloaded_cable(10, motion.static_friction), ModelRules::cured());
        CableState state = pretensioned(step.cable());
        for (const EndConditions& ends : motion.path) kinds.insert(step.advance(state, ends).pattern.kind);
    }
    EXPECT_TRUE(kinds.contains(MotionKind::partial));
    EXPECT_TRUE(kinds.contains(MotionKind::mass));
    EXPECT_TRUE(kinds.contains(MotionKind::opposed));
    EXPECT_FALSE(kinds.contains(MotionKind::slack));  // outside what the reference solvers cover
}

TEST(GenericSolver, LeavesTheStateAloneWhereItDoesNotConverge) {
    const Cable cable = test::preloaded_cable(10, 0.21);
    CableState state = pretensioned(cable);
    const CableState before = state;
    // So far in that the cable goes slack.
    const auto report = reference::GenericSolver(cable).advance(
        state, {EndCondition::position_m(0.1), EndCondition::position_m(0.0)});
    EXPECT_FALSE(report.converged);
    EXPECT_EQ(state.tension_N, before.tension_N);
    EXPECT_EQ(state.displacement_m, before.displacement_m);
}

INSTANTIATE_TEST_SUITE_P(EveryMotion, Agreement,
                         testing::Combine(testing::ValuesIn(test::all_motions(250)),
                                          testing::Values(1, 2, 3, 5, 10, 20, 40, 60)),
                         [](const testing::TestParamInfo<Case>& which) {
                             return std::get<0>(which.param).name + "_" +
                                    std::to_string(std::get<1>(which.param)) + "_segments";
                         });

}  // namespace
}  // namespace capstan
