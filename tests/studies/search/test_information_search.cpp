#include <gtest/gtest.h>

#include <algorithm>

#include "capstan/search/information_search.h"
#include "every_layout.h"

namespace capstan {
namespace {

AverageInformation information_of(const PreparedStudy& study) {
    AverageInformation information;
    for (const PreparedScenario& scenario : study.scenarios) {
        information.scenarios.emplace_back(scenario, study.plan.noise_levels[0].level);
        information.fraction.push_back(1.0 / static_cast<double>(study.scenarios.size()));
    }
    return information;
}

double nats_of(const AverageInformation& information, const std::vector<int>& nodes) {
    double nats = 0.0;
    for (std::size_t s = 0; s < information.fraction.size(); ++s)
        nats += information.fraction[s] * information.scenarios[s].nats(nodes);
    return nats;
}

double max_nats(const AverageInformation& information, const PlacementConstraints& constraints, int nodes,
                int sensors) {
    const SensorSubsets subsets(test::EveryLayout::all_nodes(nodes), nodes);
    double most = -1.0;
    for (int s = 1; s < subsets.count(); ++s) {
        if (subsets.sensors(s) == sensors && constraints.allow(subsets.nodes_of(s)))
            most = std::max(most, nats_of(information, subsets.nodes_of(s)));
    }
    return most;
}

TEST(MostInformativeLayout, IsTheBestOfAllLayouts) {
    StudyPlan plan = test::paper_plan(20);
    for (const int spacing : {1, 3}) {
        plan.placement.minimum_spacing = spacing;
        const PreparedStudy study = prepare(plan);
        const AverageInformation information = information_of(study);
        const PlacementConstraints constraints(plan.placement, study.nodes());
        for (int sensors = 1; sensors <= 4; ++sensors) {
            const MostInformative found = max_information_layout(information, constraints, sensors);
            EXPECT_LE(found.at_most_nats, found.nats);
            EXPECT_TRUE(constraints.allow(found.nodes));
            EXPECT_NEAR(found.nats, nats_of(information, found.nodes), 1e-9);
            EXPECT_NEAR(found.nats, max_nats(information, constraints, study.nodes(), sensors), 1e-9);
        }
    }
}

// A search that is cut short still bounds what it did not look at.
TEST(MostInformativeLayout, BoundHoldsWhenTheSearchIsCutShort) {
    StudyPlan plan = test::paper_plan(20);
    const PreparedStudy study = prepare(plan);
    const AverageInformation information = information_of(study);
    const PlacementConstraints constraints(plan.placement, study.nodes());
    for (const long branches : {0L, 1L, 5L, 20L}) {
        const MostInformative found = max_information_layout(information, constraints, 4, branches);
        const double most = max_nats(information, constraints, study.nodes(), 4);
        EXPECT_LE(found.nats, most + 1e-9);
        EXPECT_GE(found.at_most_nats, most - 1e-9);
    }
}

TEST(MostInformativeLayout, KeepsRequiredNodesAndReportsThatNoLayoutIsAllowed) {
    StudyPlan plan = test::paper_plan(20);
    plan.placement.required_nodes = {3};
    plan.placement.max_sensors = 3;
    const PreparedStudy study = prepare(plan);
    const PlacementConstraints constraints(plan.placement, study.nodes());
    const auto found = max_information_layout(information_of(study), constraints, 2);
    EXPECT_EQ(std::count(found.nodes.begin(), found.nodes.end(), 3), 1);
    EXPECT_TRUE(max_information_layout(information_of(study), constraints, 4).nodes.empty());
}

// Sixty-one nodes: six sensors are 55 million layouts.
TEST(MostInformativeLayout, OfALongCableHasAStatedGap) {
    StudyPlan plan = test::short_cable_plan(20);
    plan.transmission.cable.segments = 60;
    const PreparedStudy study = prepare(plan);
    const PlacementConstraints constraints(plan.placement, study.nodes());
    const auto found = max_information_layout(information_of(study), constraints, 6, 5000);
    EXPECT_EQ(found.nodes.size(), 6u);
    EXPECT_GE(found.at_most_nats, found.nats);
    EXPECT_LT(found.at_most_nats, 1.5 * found.nats);
}

}  // namespace
}  // namespace capstan
