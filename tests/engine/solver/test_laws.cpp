#include <gtest/gtest.h>

#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/sides.h"
#include "example_cables.h"
#include "trajectories.h"

namespace capstan {
namespace {

TEST(MassMotion, TensionGrowsByTheCapstanRatioTowardsWhereTheCableGoes) {
    const Cable cable(test::routed_specification(12));
    const QuasiStaticStep step(cable, ModelRules::consistent());
    for (const double way : {1.0, -1.0}) {
        CableState state = pretensioned(cable);
        // Both ends go the same way far enough to drag everything along.
        const StepReport report =
            step.advance(state, {EndCondition::position_m(state.displacement_m.front() + way * 0.05),
                                 EndCondition::position_m(state.displacement_m.back() + way * 0.05)});
        ASSERT_EQ(report.pattern.kind, MotionKind::mass);
        for (int i = 0; i < cable.segments(); ++i) {
            const double expected = std::exp(way * 0.15 * cable.wrap_angle_rad()[i]);
            EXPECT_NEAR(state.tension_N[i + 1] / state.tension_N[i], expected, 1e-12 * expected);
        }
    }
}

TEST(MassMotion, AgainstASpringTheClosedFormOfTheCompleteCableHolds) {
    const Cable cable = test::paper_cable(10);
    const QuasiStaticStep step(cable, ModelRules::consistent());
    CableState state = pretensioned(cable);
    const double stiffness_N_per_m = 40.0;
    const double pulled_m = state.displacement_m.front() - 0.06;
    const StepReport report = step.advance(
        state, {EndCondition::position_m(pulled_m), distal_spring({stiffness_N_per_m, 10.0, 0.0})});
    ASSERT_EQ(report.pattern.kind, MotionKind::mass);
    // T_1 = (T_pre - k u_1) / (P + k G), prefix sums by hand.
    const double ratio = std::exp(-0.21 * 0.2 / 0.28);
    double tension_ratio = 1.0;
    double elongation = 0.0;
    for (int i = 0; i < 10; ++i) {
        elongation += 1e-4 * 0.5 * tension_ratio * (1.0 + ratio);
        tension_ratio *= ratio;
    }
    const double expected_N =
        (10.0 - stiffness_N_per_m * pulled_m) / (tension_ratio + stiffness_N_per_m * elongation);
    EXPECT_NEAR(state.tension_N.front(), expected_N, 1e-12 * expected_N);
}

TEST(PaperReading, SlidingSegmentsStretchByE2) {
    const Cable cable = test::paper_cable(10);
    const QuasiStaticStep step(cable, ModelRules::paper());
    CableState state = pretensioned(cable);
    step.advance(state, {EndCondition::position_m(-0.08), EndCondition::position_m(0.0)});
    ASSERT_EQ(state.last_motion.kind, MotionKind::mass);
    const double exponent = -0.21 * 0.2 / 0.28;
    for (int i = 0; i < 10; ++i) {
        const double expected_m = state.tension_N[i] * 1e-4 * std::expm1(exponent) / exponent;
        EXPECT_NEAR(state.displacement_m[i + 1] - state.displacement_m[i], expected_m, 1e-15);
    }
}

class IdealCable : public testing::TestWithParam<CableSpecification> {};

TEST_P(IdealCable, CarriesTheSameTensionEverywhere) {
    const Cable cable(GetParam());
    const QuasiStaticStep step(cable, ModelRules::consistent());
    CableState state = pretensioned(cable);
    for (const EndConditions& ends : test::sine_against_locked_end(cable, 0.009, 100, 150)) {
        step.advance(state, ends);
        const double stretch_m = state.displacement_m.back() - state.displacement_m.front();
        const double expected_N = cable.axial_stiffness_N() * stretch_m / cable.length_m();
        for (const double tension_N : state.tension_N) EXPECT_NEAR(tension_N, expected_N, 1e-10);
    }
}

CableSpecification without_friction() {
    CableSpecification specification = test::paper_specification(10);
    specification.dynamic_friction = specification.static_friction = 0.0;
    return specification;
}

CableSpecification straight_conduit() {
    CableSpecification specification = test::paper_specification(10);
    specification.curvature = {{2.0, straight}};
    return specification;
}

INSTANTIATE_TEST_SUITE_P(NoFrictionOrNoBend, IdealCable,
                         testing::Values(without_friction(), straight_conduit()),
                         [](const auto& which) { return which.index == 0 ? "NoFriction" : "NoBend"; });

TEST(PartialMotion, ReachesTheFarEndWhereMassMotionBegins) {
    CableSpecification specification = test::paper_specification(10);
    specification.static_friction = specification.dynamic_friction;
    const Cable cable(specification);
    const QuasiStaticStep step(cable, ModelRules::consistent());
    const auto pulled_by = [&](double displacement_m) {
        CableState state = pretensioned(cable);
        step.advance(state, {EndCondition::position_m(state.displacement_m.front() - displacement_m),
                             EndCondition::position_m(0.0)});
        return state;
    };
    double partial_m = 0.0;
    double mass_m = 0.1;
    for (int k = 0; k < 60; ++k) {
        const double middle_m = 0.5 * (partial_m + mass_m);
        (pulled_by(middle_m).last_motion.kind == MotionKind::mass ? mass_m : partial_m) = middle_m;
    }
    const CableState before = pulled_by(partial_m);
    const CableState after = pulled_by(mass_m);
    ASSERT_EQ(before.last_motion.kind, MotionKind::partial);
    ASSERT_EQ(after.last_motion.kind, MotionKind::mass);
    for (int node = 0; node < cable.nodes(); ++node) {
        EXPECT_NEAR(before.tension_N[node], after.tension_N[node], 1e-9) << "node " << node;
        EXPECT_NEAR(before.displacement_m[node], after.displacement_m[node], 1e-13) << "node " << node;
    }
}

// E3 and E4: what friction holds moves no neighbour, wherever a search begins.
TEST(PartialMotion, BeginsWithTheEndNodeAlone) {
    const Cable cable = test::paper_cable(10);
    const PrefixTables tables(cable, ModelRules::consistent());
    const CableState state = pretensioned(cable);
    const ModelRules rules = ModelRules::consistent();
    const StepView view{tables, rules, state};
    const EndConditions ends{EndCondition::position_m(state.displacement_m.front() - 1e-6),
                             EndCondition::position_m(state.displacement_m.back() + 1e-6)};
    for (const FrontStart start : {FrontStart::remembered, FrontStart::end_of_cable}) {
        const Sides sides = find_sides(view, ends, start);
        EXPECT_EQ(sides.proximal.moving_nodes, 1);
        EXPECT_EQ(sides.distal.moving_nodes, 1);
    }
}

TEST(BadInput, IsRefusedByNameAndLeavesTheStateAlone) {
    const Cable cable = test::paper_cable(5);
    const QuasiStaticStep step(cable, ModelRules::consistent());
    CableState state = pretensioned(cable);
    const CableState before = state;
    const auto refusal = [&](const EndConditions& ends) -> std::string {
        try {
            step.advance(state, ends);
        } catch (const InvalidInput& invalid) {
            return invalid.what();
        }
        return "";
    };
    const double nan = std::nan("");
    EXPECT_NE(refusal({EndCondition::position_m(nan), EndCondition::position_m(0)}).find("proximal"),
              std::string::npos);
    EXPECT_NE(refusal({EndCondition::position_m(0), EndCondition::tension_N(INFINITY)}).find("distal"),
              std::string::npos);
    EXPECT_NE(refusal({EndCondition::tension_N(5), EndCondition::tension_N(5)}).find("both ends"),
              std::string::npos);
    EXPECT_NE(refusal({EndCondition::position_m(-1e300), EndCondition::position_m(0)}).find("1e150"),
              std::string::npos);
    // A number, but the tension of so long a pull is none.
    EXPECT_NE(refusal({EndCondition::position_m(-1e149), EndCondition::position_m(0)}).find("units"),
              std::string::npos);
    // The displacement that this factor means is none either.
    EXPECT_NE(refusal({{1e-310, 0.0, 1.0}, EndCondition::position_m(0)}).find("units"), std::string::npos);
    EXPECT_NE(refusal({EndCondition::position_m(0), distal_spring({-500.0, 10.0, 0.0})}).find("stiffness"),
              std::string::npos);
    EXPECT_NE(refusal({proximal_spring({-500.0, 10.0, 0.0}), EndCondition::position_m(0)}).find("stiffness"),
              std::string::npos);
    EXPECT_EQ(state.tension_N, before.tension_N);
    EXPECT_EQ(state.displacement_m, before.displacement_m);
}

}  // namespace
}  // namespace capstan
