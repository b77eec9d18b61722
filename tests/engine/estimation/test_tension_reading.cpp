#include <gtest/gtest.h>

#include "capstan/estimation/tension_reading.h"
#include "example_cables.h"

namespace capstan {
namespace {

TEST(SensorSpot, BetweenTwoNodesTheTensionIsInterpolated) {
    const Cable cable = test::paper_cable(10);  // a node every 0.2 m
    CableState state = pretensioned(cable);
    for (std::size_t node = 0; node < state.tension_N.size(); ++node)
        state.tension_N[node] = 10.0 + static_cast<double>(node);
    const SensorSpot spot = spot_at(cable, 0.5);
    EXPECT_EQ(spot.node, 2);
    EXPECT_NEAR(spot.fraction, 0.5, 1e-12);
    EXPECT_NEAR(tension_at_N(state, spot), 12.5, 1e-12);
}

TEST(SensorSpot, BeyondTheCableIsAtItsEnd) {
    const Cable cable = test::paper_cable(10);
    EXPECT_EQ(spot_at(cable, -1.0).node, 0);
    EXPECT_EQ(spot_at(cable, -1.0).fraction, 0.0);
    EXPECT_EQ(spot_at(cable, 5.0).node, 9);
    EXPECT_EQ(spot_at(cable, 5.0).fraction, 1.0);
}

TEST(SensorSpot, OfANodeIsTheNode) {
    const Cable cable = test::paper_cable(10);
    const CableState state = pretensioned(cable);
    for (int node = 0; node <= 10; ++node)
        EXPECT_EQ(tension_at_N(state, spot_of_node(cable, node)),
                  state.tension_N[static_cast<std::size_t>(node)]);
}

}  // namespace
}  // namespace capstan
