#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "capstan/cable/invalid_input.h"
#include "capstan/worlds/candidate.h"
#include "capstan/worlds/sensor_places.h"
#include "world_plans.h"

namespace capstan {
namespace {

using testing::arm_plan;

TEST(CandidateSets, ObeysEveryConstraint) {
    StudyPlan plan = arm_plan(20);
    plan.placement.search = ComparedSets::all;
    plan.placement.max_sensors = 3;
    plan.placement.forbidden_m = {0.35, 0.65};
    plan.placement.required_m = {1.0};
    plan.placement.minimum_spacing_m = 0.25;
    const auto offers = sensor_offers(plan);
    const auto candidates = candidates_of(plan, offers);
    ASSERT_GT(candidates.size(), 3U);
    EXPECT_TRUE(candidates.front().sensors.empty());
    for (std::size_t k = 1; k < candidates.size(); ++k) {
        const auto& sensors = candidates[k].sensors;
        EXPECT_LE(sensors.size(), 3U);
        bool has_required = false;
        for (std::size_t s = 0; s < sensors.size(); ++s) {
            const double place_m = offers[static_cast<std::size_t>(sensors[s])].place_m;
            EXPECT_TRUE(place_m < 0.35 || place_m > 0.65);
            has_required = has_required || std::abs(place_m - 1.0) < 1e-9;
            if (s > 0) {
                EXPECT_GE(place_m - offers[static_cast<std::size_t>(sensors[s - 1])].place_m, 0.25 - 1e-6);
            }
        }
        EXPECT_TRUE(has_required);
    }
}

TEST(CandidateSets, ConstraintsThatNoSetSatisfiesAreRefused) {
    StudyPlan plan = arm_plan(20);
    plan.placement.required_m = {0.5};
    plan.placement.forbidden_m = {0.4, 0.6};
    EXPECT_THROW(candidates_of(plan, sensor_offers(plan)), InvalidInput);
}

TEST(CandidateSets, EvenMeansFromEndToEnd) {
    StudyPlan plan = arm_plan(20);
    plan.transmission.cable.segments = 15;
    plan.layout_families = {"even"};
    plan.sensor_counts = {9};
    const auto offers = sensor_offers(plan);
    const auto candidates = candidates_of(plan, offers);
    ASSERT_EQ(candidates.size(), 2U);
    const auto& sensors = candidates[1].sensors;
    ASSERT_EQ(sensors.size(), 9U);
    EXPECT_EQ(offers[static_cast<std::size_t>(sensors.front())].place_m, 0.0);
    EXPECT_NEAR(offers[static_cast<std::size_t>(sensors.back())].place_m, 1.0, 1e-12);
    for (std::size_t k = 1; k < sensors.size(); ++k) EXPECT_LE(sensors[k] - sensors[k - 1], 2);
}

TEST(CandidateSets, EvenChoosesByPlaceWhereNodesAreNotEvenlySpread) {
    StudyPlan plan = arm_plan(20);
    plan.sensors = {{SensorKind::tension, {0.0, 0.1, 0.2, 0.55, 0.9, 1.0}, {0.03, 0.1, 0.0, 0.0}, 1.0}};
    plan.layout_families = {"even"};
    const auto places_of = [&](int count) {
        plan.sensor_counts = {count};
        const auto offers = sensor_offers(plan);
        std::vector<double> places_m;
        const Candidate chosen = candidates_of(plan, offers).at(1);
        for (const int sensor : chosen.sensors)
            places_m.push_back(offers[static_cast<std::size_t>(sensor)].place_m);
        return places_m;
    };
    EXPECT_EQ(places_of(1), (std::vector<double>{0.55}));
    EXPECT_EQ(places_of(3), (std::vector<double>{0.0, 0.55, 1.0}));
    EXPECT_EQ(places_of(4), (std::vector<double>{0.0, 0.2, 0.55, 1.0}));
    EXPECT_EQ(places_of(6), (std::vector<double>{0.0, 0.1, 0.2, 0.55, 0.9, 1.0}));
}

TEST(CandidateSets, SensorsOfOtherKindsComeWithEverySet) {
    StudyPlan plan = arm_plan(20);
    plan.sensors = {{SensorKind::tension, {0.0, 0.5, 1.0}, {0.03, 0.1, 0.0, 0.0}, 1.0},
                    {SensorKind::load_displacement, {}, {0.0, 1e-4, 0.0, 0.0}, 2.5}};
    const auto offers = sensor_offers(plan);
    ASSERT_EQ(offers.size(), 4U);
    int with_encoder = 0;
    for (const Candidate& candidate : candidates_of(plan, offers)) {
        const bool has =
            std::find(candidate.sensors.begin(), candidate.sensors.end(), 3) != candidate.sensors.end();
        with_encoder += has ? 1 : 0;
        EXPECT_DOUBLE_EQ(candidate.price, (candidate.count() - (has ? 1 : 0)) * 1.0 + (has ? 2.5 : 0.0));
    }
    EXPECT_GT(with_encoder, 2);
}

}  // namespace
}  // namespace capstan
