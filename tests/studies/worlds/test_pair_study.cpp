#include <gtest/gtest.h>

#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/worlds/sensor_places.h"
#include "capstan/worlds/world_study.h"
#include "world_plans.h"

namespace capstan {
namespace {

using testing::pair_plan;

TEST(PairStudy, OffersTensionSensorsOnBothCablesAndNamesThem) {
    StudyPlan plan = pair_plan();
    const auto offers = sensor_offers(plan);
    ASSERT_EQ(offers.size(), 6U);
    bool has_both = false;
    for (const Candidate& candidate : candidates_of(plan, offers)) {
        const std::string words = words_of(candidate, offers);
        has_both =
            has_both || words == "tension at 1 m of cable A; tension at 1 m of cable B; the motor's torque";
    }
    EXPECT_TRUE(has_both);
    plan.sensors[2].cable = OfferedOn::cable_b;
    const auto on_b = sensor_offers(plan);
    ASSERT_EQ(on_b.size(), 4U);
    EXPECT_EQ(on_b[2].cable, 1);
}

TEST(PairStudy, BothCablesOfAWorldDifferAndTheTorqueIsTheirDifference) {
    const WorldQuestion question = world_question(pair_plan());
    const World world = draw_world(question, 2);
    EXPECT_NE(world.factors[0].log_friction, world.factors[1].log_friction);
    ASSERT_EQ(world.nodes, 18);
    EXPECT_EQ(world.unsolved_steps, 0);
    for (int sample = 0; sample < world.samples(); ++sample) {
        const auto tension_N = world.tensions_N(sample);
        EXPECT_DOUBLE_EQ(world.sensed[static_cast<std::size_t>(sample) * question.offers.size()],
                         tension_N[0] - tension_N[9]);
    }
}

// Knowing the pair means knowing both cables.
TEST(PairStudy, WithEverythingKnownTheFilterFollowsTheTruePair) {
    StudyPlan plan = pair_plan();
    Uncertainty& unknown = plan.uncertainty;
    unknown.friction_fraction = unknown.wrap_fraction = unknown.stiffness_fraction =
        unknown.pretension_fraction = 0.0;
    unknown.far_end_range_m = 0.0;  // the wrist stays where it is
    const WorldQuestion question = world_question(plan);
    const WorldError error =
        filter_error(question, question.belief, draw_world(question, 0), ensemble_draws(question, 0), {});
    EXPECT_LT(error.worst_place_N, 1e-6);
}

TEST(PairStudy, RecommendsSensorsThatHelpAndItsBandIsHonest) {
    ErrorTable table(pair_plan(), {});
    const WorldAnswer answer = choose_sensors(table);
    ASSERT_TRUE(answer.recommended);
    EXPECT_GT(answer.gain_over_none.low_N, 0.0);
    EXPECT_GT(answer.best().expected.covered_fraction, 0.90);
    EXPECT_LT(answer.best().expected.covered_fraction, 0.98);
    EXPECT_TRUE(answer.paper.empty());  // the paper's methods are for one cable
    EXPECT_FALSE(answer.knowledge.empty());
}

TEST(PairStudy, AFurtherSensorNeverRaisesTheSquaredErrorOfAPair) {
    ErrorTable table(pair_plan(), {});
    const auto& candidates = table.candidates();
    constexpr int worlds = 60;
    std::vector<int> all;
    for (int k = 0; k < static_cast<int>(candidates.size()); ++k) all.push_back(k);
    table.fill(Condition::as_stated, all, 0, worlds, "test");
    int pairs = 0;
    for (const int a : all) {
        for (const int b : all) {
            const auto& fewer = candidates[static_cast<std::size_t>(a)].sensors;
            const auto& more = candidates[static_cast<std::size_t>(b)].sensors;
            if (fewer.size() >= more.size() ||
                !std::includes(more.begin(), more.end(), fewer.begin(), fewer.end()))
                continue;
            ++pairs;
            double mean = 0.0, squares = 0.0, before = 0.0;
            for (int w = 0; w < worlds; ++w) {
                const double was = table.at(Condition::as_stated, a, w).mean_square_N2;
                const double rise = table.at(Condition::as_stated, b, w).mean_square_N2 - was;
                mean += rise / worlds;
                squares += rise * rise / worlds;
                before += was / worlds;
            }
            const double error = std::sqrt((squares - mean * mean) / (worlds - 1));
            EXPECT_LT(mean, std::max(3.0 * error, 0.02 * before))
                << words_of(candidates[static_cast<std::size_t>(a)], table.offers()) << " to "
                << words_of(candidates[static_cast<std::size_t>(b)], table.offers());
        }
    }
    EXPECT_GT(pairs, 10);
}

bool has_problem(const StudyPlan& plan, const std::string& key) {
    const auto problems = problems_of_values(plan);
    return std::any_of(problems.begin(), problems.end(),
                       [&](const KeyProblem& problem) { return problem.key == key; });
}

TEST(PairStudy, RefusesWhatItCannotSimulate) {
    StudyPlan spring = pair_plan();
    spring.motion.distal = {.kind = EndKind::spring, .spring_stiffness_N_per_m = 1000.0};
    EXPECT_TRUE(has_problem(spring, "motion.distal.kind"));
    EXPECT_FALSE(has_problem(pair_plan(), "motion.distal.kind"));
    StudyPlan instants = pair_plan();
    instants.uncertainty.is_stated = false;
    EXPECT_TRUE(has_problem(instants, "transmission.arrangement"));
    EXPECT_FALSE(has_problem(pair_plan(), "transmission.arrangement"));
}

}  // namespace
}  // namespace capstan
