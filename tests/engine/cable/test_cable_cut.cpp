#include <gtest/gtest.h>

#include <numeric>

#include "capstan/cable/cable_cut.h"
#include "capstan/cable/cable_state.h"
#include "capstan/cable/invalid_input.h"
#include "example_cables.h"

namespace capstan {
namespace {

std::vector<double> positions_of(const Cable& cable) {
    std::vector<double> positions_m;
    for (int node = 0; node < cable.nodes(); ++node) positions_m.push_back(cable.node_position_m(node));
    return positions_m;
}

TEST(CableCut, EvenSegmentsHaveTheRelativeLengthOneExactly) {
    for (const int segments : {1, 3, 7, 10, 63, 1000}) {
        const Cable cable(test::routed_specification(segments));
        for (const double length : cable.relative_length()) EXPECT_EQ(length, 1.0);
        for (int node = 0; node <= segments; ++node) EXPECT_EQ(cable.relative_position()[node], node);
    }
}

TEST(CableCut, SharesSegmentsSoThatTheLongestIsAsShortAsPossible) {
    CableSpecification specification = test::paper_specification(5);  // 2 m
    specification.node_places_m = {0.3, 0.5};
    const std::vector<double> expected_m = {0.0, 0.3, 0.5, 1.0, 1.5, 2.0};
    EXPECT_EQ(positions_of(Cable(specification)), expected_m);
}

TEST(CableCut, NodesLieExactlyWhereTheyMust) {
    const CableSpecification specification = test::unevenly_cut_specification();
    const Cable cable(specification);
    EXPECT_EQ(cable.segments(), 12);
    for (const double place_m : specification.node_places_m) {
        const int node = cable.nearest_node(place_m);
        EXPECT_EQ(cable.node_position_m(node), place_m);
        const Cable::Spot spot = cable.spot_at(place_m);
        EXPECT_EQ(spot.segment, node);
        EXPECT_EQ(spot.fraction, 0.0);
    }
    const auto lengths = cable.relative_length();
    EXPECT_NEAR(std::accumulate(lengths.begin(), lengths.end(), 0.0), 12.0, 1e-12);
}

TEST(CableCut, BendsThatBeginAndEndAtNodesLieInTheirSegmentsAlone) {
    const Cable cable(test::unevenly_cut_specification());
    double wrap_rad = 0.0;
    for (int i = 0; i < cable.segments(); ++i) {
        const double middle_m = 0.5 * (cable.node_position_m(i) + cable.node_position_m(i + 1));
        const double radius_m = middle_m > 0.3 && middle_m < 0.5    ? 0.06
                                : middle_m > 0.8 && middle_m < 1.05 ? 0.1
                                                                    : straight;
        EXPECT_NEAR(cable.wrap_angle_rad()[i], cable.segment_length_m(i) / radius_m, 1e-12)
            << "segment " << i;
        wrap_rad += cable.wrap_angle_rad()[i];
    }
    EXPECT_NEAR(wrap_rad, 0.2 / 0.06 + 0.25 / 0.1, 1e-12);
}

TEST(CableCut, RefiningHalvesEverySegment) {
    const CableSpecification specification = test::unevenly_cut_specification();
    const std::vector<double> coarse_m = positions_of(Cable(specification));
    const std::vector<double> fine_m = positions_of(Cable(refined(specification, 2)));
    ASSERT_EQ(fine_m.size(), 2 * coarse_m.size() - 1);
    for (std::size_t node = 0; node < coarse_m.size(); ++node) EXPECT_EQ(fine_m[2 * node], coarse_m[node]);
    for (std::size_t node = 0; node + 1 < coarse_m.size(); ++node)
        EXPECT_DOUBLE_EQ(fine_m[2 * node + 1], 0.5 * (coarse_m[node] + coarse_m[node + 1]));
    EXPECT_EQ(positions_of(Cable(refined(test::routed_specification(6), 3))),
              positions_of(Cable(test::routed_specification(18))));
}

TEST(CableCut, SpotsAndNearestNodesAreThoseOfThePlace) {
    const Cable cable(test::unevenly_cut_specification());
    for (const double position_m : {0.0, 0.01, 0.31, 0.4999, 0.77, 0.925, 1.1, 1.2}) {
        const Cable::Spot spot = cable.spot_at(position_m);
        EXPECT_NEAR((1.0 - spot.fraction) * cable.node_position_m(spot.segment) +
                        spot.fraction * cable.node_position_m(spot.segment + 1),
                    position_m, 1e-12);
        for (int node = 0; node < cable.nodes(); ++node)
            EXPECT_LE(std::abs(cable.node_position_m(cable.nearest_node(position_m)) - position_m),
                      std::abs(cable.node_position_m(node) - position_m) + 1e-12);
    }
    EXPECT_EQ(cable.spot_at(-1.0).fraction, 0.0);
    EXPECT_EQ(cable.spot_at(5.0).segment, 11);
    EXPECT_EQ(cable.spot_at(5.0).fraction, 1.0);
}

TEST(CableCut, PretensionStretchesEachSegmentByItsOwnCompliance) {
    const Cable cable(test::unevenly_cut_specification());
    const CableState state = pretensioned(cable);
    for (int i = 0; i < cable.segments(); ++i)
        EXPECT_NEAR(state.displacement_m[i + 1] - state.displacement_m[i],
                    cable.segment_compliance_m_per_N(i) * 20.0, 1e-16);
}

TEST(CableCut, BendEndsAndSensorPlacesAreToldApartByAMicrometre) {
    const auto specification = test::routed_specification(12);
    const std::vector<double> ends_m = bend_ends_m(specification.curvature);
    ASSERT_EQ(ends_m.size(), 4u);
    EXPECT_EQ(bend_ends_m({{0.5, straight}, {0.5, straight}, {0.2, 0.1}}), (std::vector<double>{1.0}));
    EXPECT_EQ(distinct_places_m({0.8, 0.0, 0.3, 0.3 + 5e-7, 1.2, 1.2 - 5e-7}, 1.2),
              (std::vector<double>{0.3, 0.8}));
}

TEST(CableCut, TooFewSegmentsAndPlacesOutOfOrderAreRefusedByName) {
    const auto problems = [](int segments, std::vector<double> places_m) {
        CableSpecification specification = test::paper_specification(segments);
        specification.node_places_m = std::move(places_m);
        std::string text;
        for (const KeyProblem& problem : problems_of(specification)) text += problem.text();
        return text;
    };
    EXPECT_NE(problems(2, {0.3, 0.5}).find("need at least 3 segments"), std::string::npos);
    EXPECT_EQ(problems(3, {0.3, 0.5}), "");
    EXPECT_NE(problems(5, {0.5, 0.3}).find("must rise"), std::string::npos);
    EXPECT_NE(problems(5, {0.0, 0.3}).find("node_places_m"), std::string::npos);
    EXPECT_NE(problems(5, {0.3, 2.0}).find("node_places_m"), std::string::npos);
}

}  // namespace
}  // namespace capstan
