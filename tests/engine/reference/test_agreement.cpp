#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <set>

#include "band_lu.h"
#include "capstan/reference/generic_solver.h"
#include "capstan/reference/linear_assumed.h"
#include "capstan/solver/pull_pull.h"
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
        const QuasiStaticStep step(cable(), ModelRules::consistent());
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

// Every number of segments up to 60, at instants spread over the path.
class EverySegmentCount : public testing::TestWithParam<test::Motion> {};

TEST_P(EverySegmentCount, AgreesWithTheGenericSolverWhereverItConverges) {
    constexpr int max_segments = 60;
    constexpr int steps_between = 41;
    int steps = 0;
    int converged = 0;
    double largest_N = 0.0;
    for (int segments = 1; segments <= max_segments; ++segments) {
        const Cable cable = test::preloaded_cable(segments, GetParam().static_friction);
        const QuasiStaticStep step(cable, ModelRules::consistent());
        const reference::GenericSolver generic(cable);
        CableState state = pretensioned(cable);
        for (std::size_t n = 0; n < GetParam().path.size(); ++n) {
            CableState other = state;
            ASSERT_TRUE(step.advance(state, GetParam().path[n]).verified);
            if ((n + segments) % steps_between != 0) continue;
            ++steps;
            if (!generic.advance(other, GetParam().path[n]).converged) continue;
            ++converged;
            largest_N = std::max(largest_N, difference_N(other, state));
        }
    }
    std::cout << "    1 to 60 segments: " << converged << " of " << steps
              << " steps converged, largest difference " << largest_N << " N\n";
    EXPECT_LT(largest_N, agreement_N);
    EXPECT_GE(converged, 0.95 * steps);
}

INSTANTIATE_TEST_SUITE_P(EveryMotion, EverySegmentCount, testing::ValuesIn(test::all_motions(250)),
                         [](const auto& which) { return which.param.name; });

// The pair is two cables at the angles that it finds; each of them must be what the generic solver says.
TEST(PullPullAgreement, OfEachCableWithTheGenericSolverAtTheAnglesFound) {
    const Cable cable = test::preloaded_cable(20, 0.63);
    const PullPull pair(cable, cable, {0.020, 0.104});
    const reference::GenericSolver generic(cable);
    PullPullState state = pair.at_rest();
    const double rest_m = state.cable_a.displacement_m.front();
    int steps = 0;
    int converged = 0;
    double largest_N = 0.0;
    for (int n = 1; n <= 400; ++n) {
        const PullPullState before = state;
        const double angle = 2.0 * std::numbers::pi * n / 200.0;
        pair.advance(state, {MotorTorque{0.4 * std::sin(angle)}, LoadAngle{0.05 * std::sin(1.7 * angle)}});
        const double reeled_in_m = pair.pulleys().motor_radius_m * state.motor_angle_rad;
        const double given_m = pair.pulleys().load_radius_m * state.load_angle_rad;
        const auto compare = [&](CableState from, double proximal_m, double distal_m,
                                 const CableState& found) {
            ++steps;
            if (!generic
                     .advance(from,
                              {EndCondition::position_m(proximal_m), EndCondition::position_m(distal_m)})
                     .converged) {
                return;
            }
            ++converged;
            largest_N = std::max(largest_N, difference_N(from, found));
        };
        compare(before.cable_a, rest_m - reeled_in_m, -given_m, state.cable_a);
        compare(before.cable_b, rest_m + reeled_in_m, given_m, state.cable_b);
    }
    std::cout << "    " << converged << " of " << steps << " steps converged, largest difference "
              << largest_N << " N\n";
    EXPECT_LT(largest_N, agreement_N);
    EXPECT_GE(converged, 0.95 * steps);
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
        const QuasiStaticStep step(test::preloaded_cable(10, motion.static_friction),
                                   ModelRules::consistent());
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

// The same for those that assume a pattern: none of theirs is slack, so none verifies.
TEST(LinearAssumedSolvers, LeaveTheStateAloneWhereNoPatternVerifies) {
    const Cable cable = test::preloaded_cable(10, 0.21);
    const CableState before = pretensioned(cable);
    reference::BandLuSolver band(cable);
    reference::LinearAssumedSolver dense(cable);
    for (const double distal_m : {0.0, -0.06}) {
        const EndConditions pushed{EndCondition::position_m(0.1), EndCondition::position_m(distal_m)};
        CableState by_band = before;
        CableState by_dense = before;
        EXPECT_FALSE(band.advance(by_band, pushed).converged);
        EXPECT_FALSE(dense.advance(by_dense, pushed).converged);
        EXPECT_EQ(by_band.tension_N, before.tension_N);
        EXPECT_EQ(by_dense.displacement_m, before.displacement_m);
    }
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
