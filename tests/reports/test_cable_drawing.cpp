#include <gtest/gtest.h>

#include "capstan/reports/cable_drawing.h"

namespace capstan::reports {
namespace {

Table cable(const std::vector<Value>& radii_m) {
    Table table{
        "cable_segment", "", {"segment", "start_m", "length_m", "bend_radius_m", "wrap_angle_rad"}, {}};
    for (std::size_t k = 0; k < radii_m.size(); ++k) {
        const auto* radius_m = std::get_if<double>(&radii_m[k]);
        table.rows.push_back({static_cast<std::int64_t>(k + 1), 0.5 * static_cast<double>(k), 0.5, radii_m[k],
                              radius_m == nullptr ? 0.0 : 0.5 / *radius_m});
    }
    return table;
}

int occurrences(const std::string& text, const std::string& part) {
    int count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST(CableDrawing, PinsEverySensor) {
    const std::string svg = cable_drawing(cable({0.3, 0.3, 0.3, 0.3}), {1, 5});
    EXPECT_EQ(occurrences(svg, "class=\"sensor\""), 2);
    EXPECT_EQ(occurrences(svg, "class=\"node\""), 5);
    EXPECT_NE(svg.find("sensors at nodes 1, 5"), std::string::npos);
}

TEST(CableDrawing, JoinsNeighboursOfOneRadiusIntoOneBend) {
    const std::string svg = cable_drawing(cable({Value{}, 0.3, 0.3, 0.05}), {2});
    EXPECT_EQ(occurrences(svg, "class=\"bend\""), 2);
    EXPECT_NE(svg.find("wraps 191°"), std::string::npos);  // 1 m around 0.3 m
    EXPECT_EQ(occurrences(svg, ">straight<"), 1);
}

TEST(CableDrawing, IgnoresASensorThatIsNotOnTheCable) {
    EXPECT_EQ(occurrences(cable_drawing(cable({0.3}), {3}), "class=\"sensor\""), 0);
}

TEST(CableDrawing, DrawsNothingWithoutACable) {
    EXPECT_EQ(cable_drawing(cable({}), {1}), "");
}

TEST(CableDrawing, CopesWithManyNodes) {
    const std::string svg = cable_drawing(cable(std::vector<Value>(200, 0.3)), {100, 101});
    EXPECT_EQ(occurrences(svg, "class=\"sensor\""), 2);
}

}  // namespace
}  // namespace capstan::reports
