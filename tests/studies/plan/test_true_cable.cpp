#include <gtest/gtest.h>

#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/plan/true_motion.h"
#include "paper_plan.h"

namespace capstan {
namespace {

struct Trajectory {
    std::vector<CableState> states;
};

Trajectory truth_of(const StudyPlan& plan) {
    Trajectory trajectory;
    simulate_truth(plan,
                   [&](int, const CableState&, const CableState& now) { trajectory.states.push_back(now); });
    return trajectory;
}

// One friction coefficient: stiction is not among what effects are simulated with.
StudyPlan consistent_plan() {
    StudyPlan plan = test::paper_plan(10);
    plan.transmission.rules = ModelRules::consistent();
    plan.transmission.cable.static_friction = plan.transmission.cable.dynamic_friction;
    return plan;
}

double& number_of(StudyPlan& plan, const std::string& effect, const std::string& variant,
                  const std::string& parameter) {
    for (std::size_t e = 0; e < effect_catalogue().size(); ++e) {
        const Effect& each = effect_catalogue()[e];
        if (each.name != effect || each.variant != variant) continue;
        for (std::size_t p = 0; p < each.parameters.size(); ++p) {
            if (each.parameters[p].name == parameter) return plan.truth.effects[e][p];
        }
    }
    throw std::out_of_range(effect);
}

TEST(TrueCable, EqualToTheModelMovesLikeTheModelBitForBit) {
    const StudyPlan plan = test::paper_plan(10);
    const QuasiStaticStep step(Cable(plan.transmission.cable), plan.transmission.rules);
    const Trajectory truth = truth_of(plan);
    simulate(step, plan.motion, [&](const TrueSample& sample) {
        const CableState& state = truth.states[static_cast<std::size_t>(sample.sample - 1)];
        EXPECT_EQ(state.tension_N, sample.now.tension_N);
        EXPECT_EQ(state.displacement_m, sample.now.displacement_m);
    });
}

TEST(TrueCable, WithMoreFrictionIsTheCableWithThatFriction) {
    StudyPlan rough = consistent_plan();
    rough.truth.friction_ratio = 1.25;
    StudyPlan other = consistent_plan();
    other.transmission.cable.dynamic_friction *= 1.25;
    other.transmission.cable.static_friction *= 1.25;
    const Trajectory a = truth_of(rough);
    const Trajectory b = truth_of(other);
    for (std::size_t k = 0; k < a.states.size(); ++k) EXPECT_EQ(a.states[k].tension_N, b.states[k].tension_N);
}

// Effects are simulated on equal segments and read off where the plan's nodes are.
TEST(TrueCable, WithEffectsIsReadOffAtTheNodesOfAnUnevenCut) {
    StudyPlan even = consistent_plan();
    number_of(even, "viscous_friction", "", "drag") = 20.0;
    StudyPlan uneven = even;
    uneven.transmission.cable.node_places_m = {0.3, 0.4, 1.0, 1.8};  // 0.2 m apart in the even cut
    const Cable cable(uneven.transmission.cable);
    const Trajectory a = truth_of(even);
    const Trajectory b = truth_of(uneven);
    const int sample = 130;
    for (const double place_m : {0.4, 1.0, 1.8}) {
        const auto node = static_cast<std::size_t>(cable.nearest_node(place_m));
        ASSERT_EQ(cable.node_position_m(static_cast<int>(node)), place_m);
        const auto same = static_cast<std::size_t>(std::lround(place_m / 0.2));
        EXPECT_NEAR(b.states[sample].tension_N[node], a.states[sample].tension_N[same], 1e-9);
        EXPECT_NEAR(b.states[sample].displacement_m[node], a.states[sample].displacement_m[same], 1e-12);
    }
}

// The grid with effects and the closed form agree but for the discretisation.
TEST(TrueCable, WithNegligibleEffectsMovesLikeTheModel) {
    StudyPlan plan = consistent_plan();
    const Trajectory model = truth_of(plan);
    number_of(plan, "viscous_friction", "", "drag") = 1e-9;
    ASSERT_TRUE(plan.truth.has_effects());
    const Trajectory truth = truth_of(plan);
    ASSERT_EQ(truth.states.size(), model.states.size());
    double squares = 0.0;
    double most_N = 0.0;
    int count = 0;
    int same_motion = 0;
    for (std::size_t k = 0; k < model.states.size(); ++k) {
        for (std::size_t node = 0; node < model.states[k].tension_N.size(); ++node, ++count) {
            const double off = truth.states[k].tension_N[node] - model.states[k].tension_N[node];
            squares += off * off;
            most_N = std::max(most_N, model.states[k].tension_N[node]);
        }
        same_motion += truth.states[k].last_motion.kind == model.states[k].last_motion.kind ? 1 : 0;
    }
    EXPECT_LT(std::sqrt(squares / count), 0.02 * most_N);
    EXPECT_GT(same_motion, 9 * static_cast<int>(model.states.size()) / 10);
}

// In mass motion towards the motor tension falls over the bend by e^(mu angle) more than without it (E1).
TEST(TrueCable, WithABendLosesTensionThere) {
    constexpr double angle_rad = 1.0;
    StudyPlan plan = consistent_plan();
    const Trajectory model = truth_of(plan);
    number_of(plan, "local_bend", "cable A", "middle") = 1.1;  // between nodes 5 and 6
    number_of(plan, "local_bend", "cable A", "length") = 0.1;
    number_of(plan, "local_bend", "cable A", "angle") = angle_rad;
    const Trajectory truth = truth_of(plan);
    const std::size_t instant = 141;  // mass motion in both
    ASSERT_EQ(model.states[instant].last_motion.kind, MotionKind::mass);
    ASSERT_EQ(truth.states[instant].last_motion.kind, MotionKind::mass);
    const auto ratio = [&](const Trajectory& any) {
        return any.states[instant].tension_N[5] / any.states[instant].tension_N[6];
    };
    const double extra = std::abs(std::log(ratio(truth) / ratio(model)));
    EXPECT_NEAR(extra, plan.transmission.cable.dynamic_friction * angle_rad, 0.02);
}

TEST(TrueCable, WithEffectsNeedsPrescribedEndPositions) {
    StudyPlan plan = consistent_plan();
    number_of(plan, "creep", "", "ratio") = 0.1;
    EXPECT_TRUE(problems_of_truth(plan).empty());
    plan.motion.distal.kind = EndKind::spring;
    plan.motion.distal.spring_stiffness_N_per_m = 1000.0;
    ASSERT_EQ(problems_of_truth(plan).size(), 1u);
    EXPECT_THROW(truth_of(plan), InvalidInput);
}

TEST(TrueCable, RejectsEffectsThatDoNotBelongToTheCable) {
    for (const Effect& effect : effect_catalogue()) {
        const bool elsewhere = effect.component == "motor" || effect.component == "load_pulley" ||
                               effect.component == "environment" || effect.component == "end_fitting";
        EXPECT_FALSE(elsewhere && effect.changes_the_cable) << effect.name;
    }
}

}  // namespace
}  // namespace capstan
