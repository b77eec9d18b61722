#include <gtest/gtest.h>

#include "capstan/plan/placement_constraints.h"

namespace capstan {
namespace {

constexpr int nodes = 11;

TEST(PlacementConstraints, EachConstraintExcludesItsLayouts) {
    struct Case {
        const char* key;
        PlacementPlan plan;
        std::vector<int> allowed;
        std::vector<int> broken;
    };
    PlacementPlan costs;
    costs.node_costs = {1, 1, 1, 1, 1, 1, 1, 1, 5, 5, 5};
    costs.budget = 7.0;
    const Case cases[] = {
        {"forbidden_nodes", {.forbidden_nodes = {3}}, {2, 4}, {2, 3}},
        {"required_nodes", {.required_nodes = {10, 0}}, {0, 5, 10}, {0, 5}},
        {"minimum_spacing", {.minimum_spacing = 3}, {0, 3, 6}, {0, 3, 5}},
        {"max_sensors", {.max_sensors = 2}, {1, 2}, {1, 2, 3}},
        // Node 5 (the sixth) is the middle and in neither half.
        {"max_in_distal_half", {.max_in_distal_half = 1}, {0, 5, 9}, {6, 9}},
        {"budget", costs, {0, 1, 8}, {8, 9}},
    };
    for (const Case& each : cases) {
        const PlacementConstraints constraints(each.plan, nodes);
        EXPECT_TRUE(constraints.allow(each.allowed)) << each.key;
        EXPECT_EQ(constraints.broken_by(each.broken), std::vector<std::string>{each.key});
    }
}

TEST(PlacementConstraints, ClashNamesAMinimalGroup) {
    // Spacing and the distal half have no part in it.
    PlacementPlan plan{.required_nodes = {0, 8, 10}, .minimum_spacing = 2, .max_in_distal_half = 2};
    plan.node_costs.assign(nodes, 2.0);
    plan.budget = 5.0;
    EXPECT_EQ(PlacementConstraints(plan, nodes).clash(),
              (std::vector<std::string>{"required_nodes", "budget"}));
    plan.budget = 6.0;
    EXPECT_TRUE(PlacementConstraints(plan, nodes).clash().empty());
}

TEST(PlacementConstraints, MessageOfAClashStatesEachConstraint) {
    const PlacementPlan plan{.forbidden_nodes = {4, 7}, .required_nodes = {7}};
    const auto problems = problems_of(plan, nodes);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].text(),
              "placement.required_nodes: no layout satisfies required_nodes = [8], forbidden_nodes = [5, 8] "
              "together; loosen one of them");
}

TEST(PlacementConstraints, SingleConstraintCanBeInfeasible) {
    const auto problems = problems_of(PlacementPlan{.budget = 0.5}, nodes);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].text(), "placement.budget: no layout satisfies budget = 0.5; loosen it");
}

TEST(PlacementConstraints, RejectsNodesOutsideTheCableAndWrongNumbersOfCosts) {
    EXPECT_EQ(problems_of(PlacementPlan{.forbidden_nodes = {11}}, nodes).size(), 1u);
    EXPECT_EQ(problems_of(PlacementPlan{.node_costs = {1.0, 2.0}}, nodes).size(), 1u);
}

// No layout that is allowed has more sensors than max_sensors() says; here the bound is reached.
TEST(PlacementConstraints, MaxSensorsIsTheBoundFromSpacingAndBudget) {
    const PlacementPlan apart{.minimum_spacing = 4};
    const PlacementConstraints spaced(apart, nodes);
    EXPECT_EQ(spaced.max_sensors(), 3);
    EXPECT_TRUE(spaced.allow({0, 4, 8}));
    const PlacementPlan cheap{.budget = 4.0};
    EXPECT_EQ(PlacementConstraints(cheap, nodes).max_sensors(), 4);
}

}  // namespace
}  // namespace capstan
