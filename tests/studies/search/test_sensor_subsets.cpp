#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "capstan/search/sensor_subsets.h"

namespace capstan {
namespace {

std::vector<int> first_nodes(int count) {
    std::vector<int> nodes(count);
    std::iota(nodes.begin(), nodes.end(), 0);
    return nodes;
}

TEST(SensorSubsets, ElevenNodesHave2047DistinctLayouts) {
    const SensorSubsets subsets(first_nodes(11), 11);
    EXPECT_EQ(subsets.count(), 2048);  // and the empty set
    std::set<std::vector<int>> seen;
    for (int s = 0; s < subsets.count(); ++s) seen.insert(subsets.nodes_of(s));
    EXPECT_EQ(seen.size(), 2048u);
}

// 61 nodes have far too many sets to be looked up in a table, so their number is computed.
TEST(SensorSubsets, FindsEverySetByItsNodes) {
    for (const auto& [nodes, most] : {std::pair{11, 11}, std::pair{61, 3}, std::pair{20, 4}}) {
        const SensorSubsets subsets(first_nodes(nodes), most);
        EXPECT_EQ(subsets.count(), SensorSubsets::how_many(nodes, most));
        for (int s = 1; s < subsets.count(); ++s) {
            ASSERT_EQ(subsets.at(subsets.places(s)), s);
            ASSERT_EQ(subsets.find(subsets.nodes_of(s)), s);
        }
    }
}

TEST(SensorSubsets, EverySetIsASmallerSetPlusItsLastSensor) {
    const SensorSubsets subsets({0, 2, 3, 7, 9}, 4);
    for (int s = 1; s < subsets.count(); ++s) {
        std::vector<int> nodes = subsets.nodes_of(subsets.without_last(s));
        nodes.push_back(subsets.usable_nodes()[subsets.last_place(s)]);
        EXPECT_EQ(nodes, subsets.nodes_of(s));
    }
}

TEST(SensorSubsets, DepthFirstOrderVisitsASetRightAfterItsPrefix) {
    const SensorSubsets subsets(first_nodes(7), 5);
    std::vector<int> on_stack(subsets.max_sensors() + 1, 0);
    for (const int s : subsets.depth_first()) {
        EXPECT_EQ(on_stack[subsets.sensors(s) - 1], subsets.without_last(s));
        on_stack[subsets.sensors(s)] = s;
    }
    EXPECT_EQ(static_cast<int>(subsets.depth_first().size()), subsets.count() - 1);
}

TEST(SensorSubsets, DoesNotFindUnusableNodesOrTooLargeSets) {
    const SensorSubsets subsets({0, 2, 3, 7, 9}, 2);
    EXPECT_EQ(subsets.find({1}), -1);
    EXPECT_EQ(subsets.find({0, 2, 3}), -1);
    EXPECT_EQ(subsets.find({}), 0);
}

TEST(SensorSubsets, CountsBitsInAnyMask) {
    EXPECT_EQ(bits_in(0), 0);
    EXPECT_EQ(bits_in(~std::uint64_t{0}), 64);
    EXPECT_EQ(bits_in(0x8000000000000001), 2);
}

}  // namespace
}  // namespace capstan
