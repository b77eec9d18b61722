#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "capstan/worlds/world_trial.h"
#include "world_plans.h"

namespace capstan {
namespace {

using testing::arm_plan;

TEST(DrawnWorlds, WorldsAreThoseOfTheSeedAndOfTheTruth) {
    const StudyPlan plan = arm_plan();
    const World world = draw_world(world_question(plan), 3);
    StudyPlan other = plan;
    other.seed = 12;
    EXPECT_NE(draw_world(world_question(other), 3).factors[0].log_friction, world.factors[0].log_friction);
    StudyPlan rough = plan;
    rough.truth.friction_ratio = 1.5;
    const World about_truth = draw_world(world_question(rough), 3);
    EXPECT_EQ(about_truth.factors[0].log_friction,
              world.factors[0].log_friction);  // the draw is about another centre
    EXPECT_NE(about_truth.tensions_N(60).back(), world.tensions_N(60).back());
    StudyPlan soft = plan;
    soft.transmission.cable.segments = 4;
    const std::size_t creep = [] {
        std::size_t at = 0;
        while (effect_catalogue()[at].name != "creep") ++at;
        return at;
    }();
    soft.truth.effects[creep][0] = 0.5;
    EXPECT_TRUE(draw_world(world_question(soft), 3).has_effects);
    soft.uncertainty.truth_probability = 0.0;
    EXPECT_FALSE(draw_world(world_question(soft), 3).has_effects);
}

// With nodes at both ends of every bend and at the sensors' places, readings are tensions of nodes.
TEST(DrawnWorlds, NodesLieAtBendsAndSensorsOnEveryGrid) {
    StudyPlan plan = arm_plan(20);
    plan.sensors = {{SensorKind::tension, {0.0, 0.33, 0.97}, {0.0, 1e-12, 0.0, 0.0}, 1.0}};
    plan.transmission.cut = CableCut::at_bends;
    place_nodes(plan);
    ASSERT_TRUE(problems_of(plan).empty());
    for (const int pieces : {1, 2, 4}) {
        const WorldQuestion question = world_question(plan, pieces);
        const Cable cable(question.cable.nominal());
        ASSERT_EQ(cable.segments(), 10 * pieces);
        for (const double place_m : {0.4, 0.6, 0.8, 0.33, 0.97})
            EXPECT_NEAR(cable.node_position_m(cable.nearest_node(place_m)), place_m, 1e-12);
        const World world = draw_world(question, 2);
        for (std::size_t s = 0; s < question.offers.size(); ++s) {
            const auto node = static_cast<std::size_t>(cable.nearest_node(question.offers[s].place_m));
            EXPECT_NEAR(world.sensed[40 * question.offers.size() + s], world.tensions_N(40)[node], 1e-9);
        }
    }
}

TEST(DrawnWorlds, TooFewSegmentsForBendsAndSensorsAreRefusedWithTheNumberNeeded) {
    StudyPlan plan = arm_plan(20);
    plan.sensors = {{SensorKind::tension, {0.0, 0.33, 0.97}, {0.0, 0.1, 0.0, 0.0}, 1.0}};
    plan.transmission.cut = CableCut::at_bends;
    plan.transmission.cable.segments = 5;
    place_nodes(plan);
    const auto problems = problems_of_values(plan);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems.front().key, "transmission.segments");
    EXPECT_NE(problems.front().message.find("need at least 6 segments"), std::string::npos);
}

// Where nodes lie closer together they must not count for more of the cable.
TEST(DrawnWorlds, TheErrorIsAMeanOverTheLengthAndNotOverNodes) {
    StudyPlan plan = arm_plan(20);
    plan.transmission.cable.segments = 40;
    const WorldQuestion even = world_question(plan);
    for (double at_m = 0.01; at_m < 0.2; at_m += 0.01) plan.transmission.cable.node_places_m.push_back(at_m);
    const WorldQuestion crowded = world_question(plan);
    const auto error_N = [](const WorldQuestion& question) {
        double sum_N = 0.0;
        for (std::uint32_t index = 0; index < 10; ++index)
            sum_N += filter_error(question, question.belief, draw_world(question, index),
                                  ensemble_draws(question, index), {})
                         .mean_abs_N;
        return sum_N / 10.0;
    };
    EXPECT_NEAR(error_N(crowded), error_N(even), 0.03 * error_N(even));
}

// Common to all candidates, and nothing but a stretch of the log.
TEST(DrawnWorlds, EachWorldMovesTheFarEndByAnotherStretchOfTheLog) {
    StudyPlan plan = arm_plan();
    plan.uncertainty.far_end = FarEndKind::recorded;
    for (int k = 0; k < 400; ++k)
        plan.uncertainty.far_end_samples_m.push_back(1e-6 * k * k);  // each stretch has a slope of its own
    plan.sensors = {{SensorKind::load_displacement, {}, {0.0, 1e-12, 0.0, 0.0}, 1.0}};
    const WorldQuestion question = world_question(plan);
    std::set<int> starts;
    for (std::uint32_t world = 0; world < 50; ++world) {
        const World drawn = draw_world(question, world);
        const double first_m = drawn.sensed[0];  // 1e-6 (2 k + 1)
        const int start = static_cast<int>(std::lround((first_m / 1e-6 - 1.0) / 2.0));
        starts.insert(start);
        for (int sample = 0; sample < drawn.samples(); ++sample) {
            const double moved = start + sample + 1.0;
            EXPECT_NEAR(drawn.sensed[static_cast<std::size_t>(sample)],
                        1e-6 * (moved * moved - start * start), 1e-10);
        }
    }
    EXPECT_GT(starts.size(), 30U);
    EXPECT_GE(*starts.begin(), 0);
    EXPECT_LT(*starts.rbegin(), 400 - plan.motion.samples);
}

}  // namespace
}  // namespace capstan
