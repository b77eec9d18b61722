#include <gtest/gtest.h>

#include "capstan/cable/cable_cut.h"
#include "capstan/cable/conduit.h"
#include "capstan/cable/invalid_input.h"

namespace capstan {
namespace {

constexpr double quarter_turn_rad = 0.5 * std::numbers::pi;

TEST(Conduit, IsStraightBetweenItsBends) {
    const auto pieces = pieces_of({{quarter_turn_rad, 0.08, 0.6}, {1.0, 0.2, 0.1}}, 1.2);
    ASSERT_EQ(pieces.size(), 5u);
    EXPECT_DOUBLE_EQ(pieces[0].length_m, 0.1);
    EXPECT_EQ(pieces[0].bend_radius_m, straight);
    EXPECT_DOUBLE_EQ(pieces[1].length_m, 0.2);
    EXPECT_EQ(pieces[1].bend_radius_m, 0.2);
    EXPECT_DOUBLE_EQ(pieces[2].length_m, 0.3);
    EXPECT_DOUBLE_EQ(pieces[3].length_m / pieces[3].bend_radius_m, quarter_turn_rad);
    EXPECT_EQ(pieces[4].bend_radius_m, straight);
    EXPECT_NEAR(length_m(pieces), 1.2, 1e-12);
}

TEST(Conduit, MayBeginAndEndWithABendAndHaveNone) {
    const auto bent = pieces_of({{1.0, 0.1, 0.0}, {1.0, 0.1, 0.1}}, 0.2);
    ASSERT_EQ(bent.size(), 2u);
    EXPECT_EQ(bent[1].bend_radius_m, 0.1);
    ASSERT_EQ(pieces_of({}, 0.7).size(), 1u);
    EXPECT_EQ(pieces_of({}, 0.7)[0].bend_radius_m, straight);
}

TEST(Conduit, BendsThatOverlapOrLeaveItAreRefusedByName) {
    const auto problems = [](std::vector<Bend> bends, double length_m) {
        std::string text;
        for (const KeyProblem& problem : problems_of(bends, length_m)) text += problem.text() + "\n";
        return text;
    };
    EXPECT_NE(problems({{1.0, 0.2, 0.3}, {1.0, 0.2, 0.4}}, 1.0).find("bend[2].at_m"), std::string::npos);
    EXPECT_NE(problems({{1.0, 0.2, 0.9}}, 1.0).find("beyond the conduit"), std::string::npos);
    EXPECT_NE(problems({{1.0, 0.2, -0.1}}, 1.0).find("bend[1].at_m"), std::string::npos);
    EXPECT_NE(problems({{-1.0, 0.2, 0.1}}, 1.0).find("bend[1]"), std::string::npos);
    EXPECT_NE(problems({}, 0.0).find("length_m"), std::string::npos);
    EXPECT_THROW(pieces_of({{1.0, 0.2, 0.9}}, 1.0), InvalidInput);
}

}  // namespace
}  // namespace capstan
