// The contract of every layout family, on every cable of 2 to 30 nodes with every number of sensors.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "capstan/sensing/layout.h"

namespace capstan {
namespace {

constexpr int max_nodes = 30;

// Calls check(family, count, nodes, layouts) for every family of the catalogue.
template <typename Check>
void for_each_family_count_and_cable(const Check& check) {
    for (const LayoutFamily& family : layout_families()) {
        for (int nodes = 2; nodes <= max_nodes; ++nodes) {
            for (int count = 1; count <= nodes; ++count) {
                SCOPED_TRACE(std::string(family.name) + ": " + std::to_string(count) + " sensors on " +
                             std::to_string(nodes) + " nodes");
                check(family, count, nodes, family.layouts(count, nodes));
            }
        }
    }
}

std::vector<int> mirrored(const std::vector<int>& sensors, int nodes) {
    std::vector<int> mirror;
    for (auto node = sensors.rbegin(); node != sensors.rend(); ++node) mirror.push_back(nodes - 1 - *node);
    return mirror;
}

TEST(LayoutFamilies, PlaceTheGivenNumberOnDistinctNodesInRisingOrder) {
    for_each_family_count_and_cable(
        [](const LayoutFamily& family, int count, int nodes, const auto& layouts) {
            ASSERT_FALSE(layouts.empty());
            for (const Layout& layout : layouts) {
                EXPECT_EQ(layout.family, family.name);
                EXPECT_EQ(static_cast<int>(layout.nodes.size()), count);
                EXPECT_TRUE(std::is_sorted(layout.nodes.begin(), layout.nodes.end(), std::less_equal<>()))
                    << nodes_as_people_count(layout.nodes);
                EXPECT_GE(layout.nodes.front(), 0);
                EXPECT_LT(layout.nodes.back(), nodes);
            }
        });
}

TEST(LayoutFamilies, AsManySensorsAsNodesMeansASensorAtEveryNode) {
    for_each_family_count_and_cable([](const LayoutFamily&, int count, int nodes, const auto& layouts) {
        if (count < nodes) return;
        std::vector<int> every_node(nodes);
        std::iota(every_node.begin(), every_node.end(), 0);
        ASSERT_EQ(layouts.size(), 1u) << "all variants are the same set";
        EXPECT_EQ(layouts.front().nodes, every_node);
    });
}

TEST(LayoutFamilies, TheTwoVariantsOfEvenAndOfBothAreMirrorImages) {
    for_each_family_count_and_cable([](const LayoutFamily& family, int, int nodes, const auto& layouts) {
        if (family.name == "distal") return;
        if (layouts.size() == 1) {
            EXPECT_EQ(layouts[0].start, "");
            EXPECT_EQ(layouts[0].nodes, mirrored(layouts[0].nodes, nodes));
            return;
        }
        ASSERT_EQ(layouts.size(), 2u);
        EXPECT_EQ(layouts[0].start, "proximal");
        EXPECT_EQ(layouts[1].start, "distal");
        EXPECT_EQ(layouts[0].nodes, mirrored(layouts[1].nodes, nodes));
        EXPECT_NE(layouts[0].nodes, layouts[1].nodes);
    });
}

TEST(LayoutFamilies, EvenHasTheLargestPossibleSpacing) {
    for_each_family_count_and_cable(
        [](const LayoutFamily& family, int count, int nodes, const auto& layouts) {
            if (family.name != "even" || count < 2) return;
            for (const Layout& layout : layouts) {
                const int spacing = layout.nodes[1] - layout.nodes[0];
                for (int k = 1; k < count; ++k) EXPECT_EQ(layout.nodes[k] - layout.nodes[k - 1], spacing);
                EXPECT_GT((spacing + 1) * (count - 1), nodes - 1) << "a wider spacing would fit";
            }
        });
}

TEST(LayoutFamilies, ALabelNamesOneLayoutOfACable) {
    for (int nodes = 2; nodes <= max_nodes; ++nodes) {
        std::set<std::string> labels;
        for (const LayoutFamily& family : layout_families()) {
            for (int count = 1; count <= nodes; ++count) {
                for (const Layout& layout : family.layouts(count, nodes)) {
                    EXPECT_TRUE(labels.insert(layout.label).second) << layout.label << " on " << nodes;
                }
            }
        }
    }
}

// The paper's three families on its cable of 11 nodes.
TEST(LayoutFamilies, ThreeSensorsOnThePapersCable) {
    const auto nodes_of = [](const char* family) {
        return find_layout_family(family)->layouts(3, 11)[0].nodes;
    };
    EXPECT_EQ(nodes_of("even"), (std::vector<int>{0, 5, 10}));
    EXPECT_EQ(nodes_of("distal"), (std::vector<int>{8, 9, 10}));
    EXPECT_EQ(nodes_of("both"), (std::vector<int>{0, 1, 10}));
    EXPECT_EQ(find_layout_family("random"), nullptr);
}

TEST(ExplicitLayout, ListsItsNodesInRisingOrderCountedFromOne) {
    const Layout layout = explicit_layout({10, 0, 5});
    EXPECT_EQ(layout.nodes, (std::vector<int>{0, 5, 10}));
    EXPECT_EQ(layout.label, "Nodes 1, 6, 11");
    EXPECT_EQ(layout.family, "explicit");
}

}  // namespace
}  // namespace capstan
