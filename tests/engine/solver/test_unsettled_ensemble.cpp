// An ensemble in states outside the friction cone: each member takes the step of its own cable, and the
// search runs only where the first pattern of that step fails.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "capstan/solver/cable_ensemble.h"
#include "capstan/solver/pattern_search.h"
#include "capstan/solver/quasi_static_step.h"
#include "capstan/solver/sides.h"
#include "example_cables.h"
#include "input_pairs.h"
#include "random_walk.h"

namespace capstan {
namespace {

// True if the pattern that the fronts give verifies. An ensemble always searches where they meet in one
// segment (E8).
bool first_pattern_verifies(const StepView& view, const EndConditions& ends) {
    const Sides sides = find_sides(view, ends, FrontStart::remembered);
    if (view.before.last_motion.kind == MotionKind::slack) return false;
    if (!sides.meet(view)) return verifies(view, partial_motion(sides.proximal, sides.distal));
    if (sides.meet_in_one_segment(view)) return false;
    const Candidate likely = sides.driven_against_each_other()
                                 ? opposed_motion(view, ends, sides.proximal.direction)
                                 : mass_motion(view, ends, sides.common_direction());
    return likely.pattern.kind != MotionKind::slack && verifies(view, likely);
}

bool both_ends_are_driven(const StepView& view, const EndConditions& ends) {
    const Sides sides = find_sides(view, ends, FrontStart::remembered);
    return sides.proximal.direction != Direction::none && sides.distal.direction != Direction::none;
}

class UnsettledEnsemble : public testing::TestWithParam<test::EndKind> {
  protected:
    static constexpr int members = 8;

    // What single cables do from the states of the members.
    struct Expected {
        int searched = 0;
        int unverified = 0;
        int uncertain = 0;               // members whose result depends on rounding
        std::vector<CableState> states;  // members; empty where uncertain
    };

    // The factors are the same for all members, the values are their own.
    EndCondition distal_input(const CableState& state) {
        const double far_N = state.tension_N.back();
        const double far_m = state.displacement_m.back();
        switch (GetParam()) {
            case test::EndKind::position:
                return EndCondition::position_m(far_m + test::random_size(-18.0, -2.5, random));
            case test::EndKind::tension:
                return EndCondition::tension_N(std::max(far_N + test::random_size(-16.0, 1.0, random), 0.5));
            case test::EndKind::spring:
                return distal_spring({500.0, far_N + test::random_size(-16.0, 1.0, random), far_m});
        }
        return {};
    }

    // Changes the tensions of a member; from pretension if it is slack or stretched too far.
    void unsettle_member(int member) {
        CableState state = ensemble.state_of(member);
        const double stretch_m = state.displacement_m.back() - state.displacement_m.front();
        if (!(stretch_m > 1e-3 && stretch_m < 0.1)) state.tension_N = pretensioned(cable).tension_N;
        test::unsettle(state, step.tables(), random);
        for (int node = 0; node < cable.nodes(); ++node) {
            ensemble.tension_N(node)[member] = state.tension_N[node];
            ensemble.displacement_m(node)[member] = state.displacement_m[node];
        }
    }

    void step_alone(int member, double near_m, const EndCondition& distal, Expected& expected) const {
        CableState state = ensemble.state_of(member);
        const EndConditions ends{EndCondition::position_m(state.displacement_m.front() + near_m), distal};
        const StepView view{step.tables(), step.rules(), state};
        const bool by_fronts = first_pattern_verifies(view, ends);
        // The search also tries patterns in which an end moves that is not driven; rounding decides its way.
        const bool is_certain = by_fronts || both_ends_are_driven(view, ends);
        const bool verified = step.advance(state, ends).verified;
        expected.searched += by_fronts ? 0 : 1;
        expected.uncertain += is_certain ? 0 : 1;
        expected.unverified += is_certain && !verified ? 1 : 0;
        expected.states.push_back(is_certain ? state : CableState{});
    }

    void expect_same(int member, const CableState& alone) const {
        const CableState state = ensemble.state_of(member);
        const double largest_N = *std::max_element(alone.tension_N.begin(), alone.tension_N.end());
        for (int node = 0; node < ensemble.nodes(); ++node) {
            ASSERT_NEAR(state.tension_N[node], alone.tension_N[node], 1e-9 * largest_N);
            ASSERT_NEAR(state.displacement_m[node], alone.displacement_m[node], 1e-12);
        }
        const MotionPattern& moved = state.last_motion;
        const MotionPattern& expected = alone.last_motion;
        ASSERT_EQ(moved.kind == MotionKind::slack, expected.kind == MotionKind::slack);
        ASSERT_EQ(moved.proximal_direction, expected.proximal_direction);
        ASSERT_EQ(moved.proximal_moving_nodes, expected.proximal_moving_nodes);
        ASSERT_EQ(moved.distal_direction, expected.distal_direction);
        ASSERT_EQ(moved.distal_moving_nodes, expected.distal_moving_nodes);
    }

    const Cable cable{test::unevenly_cut_specification()};
    const QuasiStaticStep step{cable, ModelRules::consistent()};
    CableEnsemble ensemble{cable, members};
    std::mt19937_64 random{5};
};

TEST_P(UnsettledEnsemble, TakesTheStepOfEachCableAndSearchesWhereItsFirstPatternFails) {
    constexpr int steps = 3000;
    int searched = 0;
    for (int k = 0; k < steps; ++k) {
        const double near_m = test::random_size(-18.0, -2.5, random);
        Expected expected;
        std::vector<double> value;
        EndCondition distal;
        for (int member = 0; member < members; ++member) {
            const CableState state = ensemble.state_of(member);
            if (k % 6 == 0 || state.displacement_m.back() - state.displacement_m.front() > 0.1)
                unsettle_member(member);
            distal = distal_input(ensemble.state_of(member));
            value.push_back(distal.value);
            step_alone(member, near_m, distal, expected);
        }
        const EnsembleReport report =
            ensemble.advance(near_m, {distal.displacement_factor, distal.tension_factor, value});
        ASSERT_EQ(report.searched, expected.searched) << k;
        ASSERT_GE(report.unverified, expected.unverified) << k;
        ASSERT_LE(report.unverified, expected.unverified + expected.uncertain) << k;
        for (int member = 0; member < members; ++member) {
            if (!expected.states[member].tension_N.empty()) expect_same(member, expected.states[member]);
            if (HasFatalFailure()) FAIL() << "step " << k << ", member " << member;
        }
        searched += report.searched;
    }
    EXPECT_GT(searched, 0);
    EXPECT_LT(searched, steps * members / 2);
}

INSTANTIATE_TEST_SUITE_P(EveryDistalEnd, UnsettledEnsemble,
                         testing::Values(test::EndKind::position, test::EndKind::tension,
                                         test::EndKind::spring),
                         [](const auto& which) { return test::name_of(which.param); });

}  // namespace
}  // namespace capstan
