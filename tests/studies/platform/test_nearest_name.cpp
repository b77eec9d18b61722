#include <gtest/gtest.h>

#include "capstan/platform/nearest_name.h"

namespace capstan {
namespace {

const std::vector<std::string> known = {"segments", "pretension_N", "report", "recommend"};

TEST(NearestName, FindsLettersSwappedLeftOutOrAdded) {
    EXPECT_EQ(nearest_name("segmnets", known), "segments");
    EXPECT_EQ(nearest_name("segment", known), "segments");
    EXPECT_EQ(nearest_name("reprot", known), "report");
    EXPECT_EQ(nearest_name("recomend", known), "recommend");
}

TEST(NearestName, IgnoresTheCaseAndAMissingUnit) {
    EXPECT_EQ(nearest_name("Pretension_n", known), "pretension_N");
    EXPECT_EQ(nearest_name("pretension", known), "pretension_N");
}

TEST(NearestName, IsEmptyWithoutANearName) {
    EXPECT_EQ(nearest_name("colour", known), std::nullopt);
    EXPECT_EQ(nearest_name("x", known), std::nullopt);
}

}  // namespace
}  // namespace capstan
