#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "capstan/sensitivity/morris_design.h"

namespace capstan::sensitivity {
namespace {

std::vector<std::vector<double>> evaluate(const MorrisDesign& design,
                                          double (*f)(const std::vector<double>&)) {
    std::vector<std::vector<double>> result;
    for (const auto& walk : design.points) {
        result.emplace_back();
        for (const auto& point : walk) result.back().push_back(f(point));
    }
    return result;
}

TEST(MorrisDesign, EachWalkMovesAlongEveryAxisOnceAndStaysInside) {
    const MorrisDesign design = morris_design(50, 4, 7);
    for (std::size_t t = 0; t < design.points.size(); ++t) {
        std::vector<int> moved(4, 0);
        for (int k = 0; k < 4; ++k) {
            const int axis = design.moved_axis[t][k];
            ++moved[axis];
            for (int other = 0; other < 4; ++other) {
                const double step = design.points[t][k + 1][other] - design.points[t][k][other];
                EXPECT_NEAR(std::abs(step), other == axis ? morris_step : 0.0, 1e-15);
                EXPECT_GE(design.points[t][k + 1][other], -1e-15);
                EXPECT_LE(design.points[t][k + 1][other], 1.0 + 1e-15);
            }
        }
        EXPECT_EQ(moved, (std::vector<int>{1, 1, 1, 1}));
    }
}

TEST(MorrisDesign, IsReproducibleFromItsSeed) {
    EXPECT_EQ(morris_design(10, 3, 5).points, morris_design(10, 3, 5).points);
    EXPECT_NE(morris_design(10, 3, 5).points, morris_design(10, 3, 6).points);
}

TEST(ElementaryEffects, OfALinearFunctionAreItsSlopes) {
    const MorrisDesign design = morris_design(20, 3, 1);
    const auto effects = elementary_effects(
        design, evaluate(design, [](const std::vector<double>& x) { return 3.0 * x[0] - 2.0 * x[1]; }));
    EXPECT_NEAR(effects[0].mean, 3.0, 1e-12);
    EXPECT_NEAR(effects[1].mean, -2.0, 1e-12);
    EXPECT_NEAR(effects[1].mean_absolute, 2.0, 1e-12);
    EXPECT_NEAR(effects[2].mean_absolute, 0.0, 1e-12);
    for (const ElementaryEffects& effect : effects) EXPECT_NEAR(effect.spread, 0.0, 1e-12);
}

// What x does depends on y, so that effects of either sign average out but their size does not.
TEST(ElementaryEffects, OfAProductSpread) {
    const MorrisDesign design = morris_design(200, 2, 1);
    const auto effects = elementary_effects(
        design, evaluate(design, [](const std::vector<double>& x) { return (x[0] - 0.5) * (x[1] - 0.5); }));
    EXPECT_LT(std::abs(effects[0].mean), 0.06);
    EXPECT_GT(effects[0].mean_absolute, 0.2);
    EXPECT_GT(effects[0].spread, 0.2);
}

TEST(ElementaryEffects, SkipStepsWithoutAResult) {
    const MorrisDesign design = morris_design(20, 2, 1);
    const auto effects =
        elementary_effects(design, evaluate(design, [](const std::vector<double>& x) {
                               return x[1] > 0.9 ? std::numeric_limits<double>::quiet_NaN() : x[0];
                           }));
    EXPECT_NEAR(effects[0].mean, 1.0, 1e-12);
    EXPECT_LT(effects[0].steps, 20);
}

}  // namespace
}  // namespace capstan::sensitivity
