// Steps from states outside the friction cone, as after friction has fallen or a measurement has corrected a
// tension: each result obeys the laws or is reported as not verified, and no cable pushes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capstan/solver/sides.h"
#include "capstan/solver/sliding_run.h"
#include "example_cables.h"
#include "random_walk.h"

namespace capstan {
namespace {

using test::InputPair;

struct StepFrom {
    const QuasiStaticStep& step;
    CableState before;
    EndConditions ends;
    CableState after;
    StepReport report;

    StepFrom(const QuasiStaticStep& solver, const CableState& state, const EndConditions& inputs)
        : step(solver), before(state), ends(inputs), after(state), report(solver.advance(after, ends)) {}

    int segments() const { return step.cable().segments(); }
    int near() const { return report.pattern.proximal_moving_nodes; }
    int far_first() const { return segments() + 1 - report.pattern.distal_moving_nodes; }

    bool friction_holds(int segment, double exponent) const {  // E4, E8
        const double ratio = after.tension_N[segment + 1] / after.tension_N[segment];
        return std::abs(std::log(ratio)) <= exponent + 2.0 * tension_rounding;
    }
    double holding_exponent(int segment) const {
        const bool slid = segment_direction(before.last_motion, segment, segments()) != Direction::none;
        const Cable& cable = step.cable();
        return (slid ? cable.dynamic_friction() : cable.static_friction()) * cable.wrap_angle_rad()[segment];
    }
    bool fronts_hold() const {
        if (report.pattern.kind != MotionKind::partial) return true;
        if (near() == far_first())
            return friction_holds(
                near() - 1, step.cable().dynamic_friction() * step.cable().wrap_angle_rad()[near() - 1]);
        return (near() == 0 || friction_holds(near() - 1, holding_exponent(near() - 1))) &&
               (far_first() > segments() ||
                friction_holds(far_first() - 1, holding_exponent(far_first() - 1)));
    }
    bool moves_its_way() const {  // E5
        for (int node = 0; node <= segments(); ++node) {
            const double increment_m = after.displacement_m[node] - before.displacement_m[node];
            const int way = sign(node_direction(report.pattern, node, segments()));
            if (way * increment_m < -1.01 * displacement_rounding_m) return false;
        }
        return true;
    }
};

class UnsettledStates : public testing::TestWithParam<InputPair> {
  protected:
    // A random walk whose state is unsettled before every fourth step; calls `check` with each step.
    template <class Check>
    void walk(unsigned seed, Check&& check) const {
        std::mt19937_64 random(seed);
        test::RandomWalk inputs(step.cable(), GetParam(), 1e-4, seed);
        CableState state = pretensioned(step.cable());
        for (int k = 0; k < 3000; ++k) {
            if (!test::moderately_stretched(state)) state = pretensioned(step.cable());
            if (k % 4 == 0) test::unsettle(state, step.tables(), random);
            inputs.set_step_m(std::abs(test::random_size(-7.0, -3.0, random)));
            const StepFrom taken(step, state, inputs.next(state));
            check(taken);
            if (HasFailure()) FAIL() << "seed " << seed << ", step " << k;
            state = taken.after;
        }
    }

    const QuasiStaticStep step{Cable(test::routed_specification(13)), ModelRules::consistent()};
};

TEST_P(UnsettledStates, AStepIsVerifiedIfAndOnlyIfItsFrontsHoldAndItsNodesMoveTheirWay) {
    int unverified = 0;
    walk(1, [&](const StepFrom& taken) {
        EXPECT_EQ(taken.report.verified, taken.fronts_hold() && taken.moves_its_way());
        unverified += taken.report.verified ? 0 : 1;
    });
    EXPECT_GT(unverified, 0);
}

TEST_P(UnsettledStates, NoCablePushes) {
    walk(2, [&](const StepFrom& taken) {
        for (const double tension_N : taken.after.tension_N) ASSERT_GE(tension_N, 0.0);
    });
}

TEST_P(UnsettledStates, RestingNodesKeepTheirStateToTheLastBit) {
    walk(3, [&](const StepFrom& taken) {
        if (taken.report.pattern.kind == MotionKind::slack) return;
        for (int node = taken.near(); node < taken.far_first(); ++node) {
            ASSERT_EQ(taken.after.tension_N[node], taken.before.tension_N[node]);
            ASSERT_EQ(taken.after.displacement_m[node], taken.before.displacement_m[node]);
        }
    });
}

// If no pattern verifies, the fronts are where friction stops them, unless that would have an end push.
TEST_P(UnsettledStates, AnUnverifiedStepEndsWhereFrictionStopsTheFronts) {
    int kept = 0;
    walk(4, [&](const StepFrom& taken) {
        if (taken.report.verified) return;
        const StepView view{taken.step.tables(), taken.step.rules(), taken.before};
        const Sides sides = find_sides(view, taken.ends, FrontStart::remembered);
        if (sides.meet(view)) return;
        const Candidate likely = partial_motion(sides.proximal, sides.distal);
        const bool pushes = std::min(likely.proximal.tension_N, likely.distal.tension_N) < 0.0;
        ASSERT_EQ(taken.report.pattern == likely.pattern, !pushes);
        kept += pushes ? 0 : 1;
    });
    EXPECT_GT(kept, 0);
}

INSTANTIATE_TEST_SUITE_P(EveryInputPair, UnsettledStates, testing::ValuesIn(test::every_input_pair()),
                         [](const auto& which) { return test::name_of(which.param); });

}  // namespace
}  // namespace capstan
