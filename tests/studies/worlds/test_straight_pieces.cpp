#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "capstan/cable/cable_cut.h"
#include "capstan/worlds/sensor_places.h"
#include "capstan/worlds/straight_pieces.h"
#include "capstan/worlds/world_study.h"
#include "world_plans.h"

namespace capstan {
namespace {

using testing::arm_plan;

// Straight to 0.4 m and from 0.6 to 0.8 m; nodes at both ends of each bend.
StudyPlan plan_with_places(std::vector<double> places_m) {
    StudyPlan plan = arm_plan(20);
    plan.transmission.cut = CableCut::at_bends;
    plan.sensors = {{SensorKind::tension, std::move(places_m), {0.03, 0.1, 0.1, 0.01}, 1.0}};
    plan.placement.search = ComparedSets::all;
    place_nodes(plan);
    return plan;
}

WorldError error_of(const WorldQuestion& question, const std::vector<int>& sensors, std::uint32_t world) {
    return filter_error(question, question.belief, draw_world(question, world),
                        ensemble_draws(question, world), sensors);
}

TEST(StraightPieces, EndWhereBendsBegin) {
    const StudyPlan plan = plan_with_places({0.0, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0});
    const auto offers = sensor_offers(plan);
    const auto pieces = straight_pieces(plan, offers);
    const std::vector<std::pair<double, double>> expected = {{0.0, 0.4}, {0.0, 0.4}, {0.0, 0.4},
                                                             {0.5, 0.5}, {0.6, 0.8}, {0.6, 0.8},
                                                             {0.6, 0.8}, {0.9, 0.9}, {1.0, 1.0}};
    ASSERT_EQ(pieces.size(), expected.size());
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        EXPECT_NEAR(pieces[k].from_m, expected[k].first, 1e-12) << k;
        EXPECT_NEAR(pieces[k].to_m, expected[k].second, 1e-12) << k;
    }
    EXPECT_EQ(first_alike(plan, offers), (std::vector<int>{0, 0, 0, 3, 4, 4, 4, 7, 8}));
}

TEST(StraightPieces, OtherErrorsAndEffectsAlongTheCableMakeSensorsDiffer) {
    StudyPlan plan = plan_with_places({0.0, 0.3});
    plan.sensors.push_back({SensorKind::tension, {0.2}, {0.03, 0.2, 0.1, 0.01}, 1.0});
    EXPECT_EQ(first_alike(plan, sensor_offers(plan)), (std::vector<int>{0, 0, 2}));
    plan.sensors.back().errors = plan.sensors.front().errors;
    plan.sensors.back().price = 5.0;
    EXPECT_EQ(first_alike(plan, sensor_offers(plan)), (std::vector<int>{0, 0, 0}));
    std::size_t drag = 0;
    while (effect_catalogue()[drag].name != "viscous_friction") ++drag;
    plan.truth.effects[drag][0] = 20.0;
    EXPECT_EQ(first_alike(plan, sensor_offers(plan)), (std::vector<int>{0, 1, 2}));
}

// Without friction between them, but for rounding: one place stands for the piece.
TEST(StraightPieces, SensorsInOnePieceReadTheSameAndErrTheSame) {
    const StudyPlan plan = plan_with_places({0.0, 0.3, 0.6, 0.7, 0.9});
    const WorldQuestion question = world_question(plan);
    for (std::uint32_t world = 0; world < 4; ++world) {
        const World drawn = draw_world(question, world);
        for (std::size_t at = 0; at < drawn.sensed.size(); at += 5) {
            EXPECT_NEAR(drawn.sensed[at], drawn.sensed[at + 1], 1e-9);
            EXPECT_NEAR(drawn.sensed[at + 2], drawn.sensed[at + 3], 1e-9);
        }
        const WorldError here = error_of(question, {0, 2}, world);
        const WorldError there = error_of(question, {1, 3}, world);
        EXPECT_NEAR(here.mean_abs_N, there.mean_abs_N, 1e-9);
        EXPECT_NEAR(here.mean_square_N2, there.mean_square_N2, 1e-9);
        EXPECT_GT(std::abs(error_of(question, {0, 4}, world).mean_abs_N - here.mean_abs_N), 1e-4);
    }
}

// A second sensor has noise, zero and gain of its own, so it tells more.
TEST(StraightPieces, TwoSensorsInOnePieceAreNotOne) {
    StudyPlan plan = plan_with_places({0.0, 0.3});
    plan.repetitions = 60;
    ErrorTable table(plan, {});
    const int one = table.candidate_of({0});
    const int two = table.candidate_of({0, 1});
    EXPECT_TRUE(table.are_alike(one, table.candidate_of({1})));
    EXPECT_FALSE(table.are_alike(one, two));
    table.fill(Condition::as_stated, std::vector{one, two}, 0, 60, "test");
    double fall_N2 = 0.0;
    for (int world = 0; world < 60; ++world)
        fall_N2 += table.at(Condition::as_stated, one, world).mean_square_N2 -
                   table.at(Condition::as_stated, two, world).mean_square_N2;
    EXPECT_GT(fall_N2, 0.0);
}

TEST(StraightPieces, JoiningTheirSegmentsChangesNoError) {
    const StudyPlan plan = plan_with_places({0.0, 0.2, 0.7, 0.9});
    for (const int pieces : {1, 2}) {
        const WorldQuestion in_pieces = world_question(plan, pieces);
        WorldQuestion joined = in_pieces;
        joined.cable = UncertainCable(with_straight_joined(in_pieces.cable.nominal()));
        ASSERT_LT(joined.cable.nominal().segments, in_pieces.cable.nominal().segments);
        EXPECT_EQ(Cable(joined.cable.nominal()).length_m(), Cable(in_pieces.cable.nominal()).length_m());
        for (std::uint32_t world = 0; world < 4; ++world) {
            const WorldError a = error_of(in_pieces, {0, 2, 3}, world);
            const WorldError b = error_of(joined, {0, 2, 3}, world);
            EXPECT_NEAR(a.mean_abs_N, b.mean_abs_N, 1e-8);
            EXPECT_NEAR(a.load_end_N, b.load_end_N, 1e-8);
            EXPECT_NEAR(a.worst_place_N, b.worst_place_N, 1e-8);
            EXPECT_NEAR(a.mean_square_N2, b.mean_square_N2, 1e-8);
            EXPECT_NEAR(a.covered_fraction, b.covered_fraction, 1e-8);
        }
    }
}

// Of sets that are the same to the model the answer names the first, and counts the others apart.
TEST(StraightPieces, TheAnswerNamesTheFirstOfSetsThatAreTheSame) {
    StudyPlan plan = plan_with_places({0.0, 0.1, 0.3, 0.6, 0.7, 1.0});
    ErrorTable table(plan, {});
    const WorldAnswer answer = choose_sensors(table);
    for (const PriceBest& best : answer.prices) {
        for (const int alike : best.alike) {
            EXPECT_GT(alike, best.expected.candidate);
            EXPECT_TRUE(table.are_alike(alike, best.expected.candidate));
            EXPECT_EQ(table.at(Condition::as_stated, alike, 0),
                      table.at(Condition::as_stated, best.expected.candidate, 0));
        }
        for (const int tie : best.ties) EXPECT_FALSE(table.are_alike(tie, best.expected.candidate));
    }
    EXPECT_TRUE(std::any_of(answer.prices.begin(), answer.prices.end(),
                            [](const PriceBest& best) { return !best.alike.empty(); }));
}

}  // namespace
}  // namespace capstan
