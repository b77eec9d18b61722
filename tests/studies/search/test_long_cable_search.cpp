#include <gtest/gtest.h>

#include <algorithm>

#include "capstan/cable/invalid_input.h"
#include "capstan/search/sensor_placement.h"
#include "every_layout.h"

namespace capstan {
namespace {

const ScopeAnswer& duty_cycle(const PlacementAnswer& answer) {
    return *std::find_if(answer.scopes.begin(), answer.scopes.end(),
                         [](const ScopeAnswer& scope) { return scope.scope == "duty_cycle"; });
}

using test::alone;

// On a cable short enough for both; they share their draws, so equal layouts have equal errors up to
// rounding.
TEST(LongCableSearch, IsNeverBetterThanTheExhaustiveSearchAndBoundsTheGap) {
    const StudyPlan plan = test::short_cable_plan(80);
    const PlacementAnswer greedy = search_long_cable(plan, alone());
    const PlacementAnswer exact = place_sensors(plan, alone());
    EXPECT_EQ(greedy.search, SearchKind::greedy);
    const auto& found = duty_cycle(greedy).counts;
    const auto& best = duty_cycle(exact).counts;
    ASSERT_EQ(found.size(), best.size());
    for (std::size_t k = 0; k < best.size(); ++k) {
        EXPECT_GE(found[k].optimum.searched_N, best[k].optimum.searched_N - 1e-12);
        const double to_all_N =
            found[k].optimum.independent.value_N - found.back().optimum.independent.value_N;
        EXPECT_NEAR(found[k].at_most_better_N, std::max(0.0, to_all_N), 1e-12);
    }
    EXPECT_NEAR(found[0].optimum.searched_N, best[0].optimum.searched_N, 1e-12);
}

TEST(LongCableSearch, SearchesSixtySegmentsUnderConstraints) {
    StudyPlan plan = test::short_cable_plan(20);
    plan.transmission.cable.segments = 60;
    plan.fusion_methods = {"maximum_likelihood"};
    plan.curve_points = 32;
    plan.placement.required_nodes = {0};
    plan.placement.forbidden_nodes = {60};
    plan.placement.minimum_spacing = 5;
    plan.placement.max_in_distal_half = 2;
    plan.placement.max_sensors = 4;
    const PlacementAnswer answer = place_sensors(plan, alone());
    EXPECT_EQ(answer.search, SearchKind::greedy);
    const PlacementConstraints constraints(plan.placement, 61);
    ASSERT_EQ(duty_cycle(answer).counts.size(), 4u);
    for (const CountAnswer& count : duty_cycle(answer).counts) {
        EXPECT_TRUE(constraints.allow(count.optimum.nodes)) << nodes_as_people_count(count.optimum.nodes);
    }
}

TEST(LongCableSearch, FewSensorsOnALongCableAreSearchedExhaustively) {
    StudyPlan plan = test::short_cable_plan(10);
    plan.transmission.cable.segments = 60;
    plan.fusion_methods = {"maximum_likelihood"};
    plan.placement.max_sensors = 2;
    const PlacementAnswer answer = place_sensors(plan, alone());
    EXPECT_EQ(answer.search, SearchKind::exhaustive);
    EXPECT_EQ(answer.layouts, 61 + 61 * 60 / 2);
}

TEST(LongCableSearch, RejectsUnsupportedObjectives) {
    StudyPlan plan = test::short_cable_plan(20);
    plan.placement.objective = PlacementObjective::worst_node;
    EXPECT_THROW(search_long_cable(plan, alone()), InvalidInput);
}

}  // namespace
}  // namespace capstan
