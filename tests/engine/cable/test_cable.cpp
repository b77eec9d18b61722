#include <gtest/gtest.h>

#include <limits>

#include "capstan/cable/cable_state.h"
#include "capstan/cable/invalid_input.h"
#include "example_cables.h"

namespace capstan {
namespace {

std::string refusal(const CableSpecification& specification) {
    try {
        Cable cable(specification);
    } catch (const InvalidInput& invalid) {
        return invalid.what();
    }
    return "";
}

TEST(Cable, CuttingIntoSegmentsKeepsTheTotalWrapAngle) {
    const double wrap_rad = 0.2 / 0.06 + 0.25 / 0.1;
    for (const int segments : {1, 2, 3, 7, 10, 60, 1000}) {
        const Cable cable(test::routed_specification(segments));
        double sum_rad = 0.0;
        for (const double segment_rad : cable.wrap_angle_rad()) sum_rad += segment_rad;
        EXPECT_NEAR(sum_rad, wrap_rad, 1e-12 * segments) << segments << " segments";
    }
}

TEST(Cable, StraightPiecesHaveNoWrapAngle) {
    const Cable cable(test::routed_specification(12));  // 0.1 m each
    for (const int straight_segment : {0, 1, 2, 5, 6, 7, 11}) {
        EXPECT_NEAR(cable.wrap_angle_rad()[straight_segment], 0.0, 1e-12);
    }
    EXPECT_GT(cable.wrap_angle_rad()[3], 1.0);
}

TEST(Cable, PretensionStretchesUniformly) {
    const Cable cable = test::paper_cable(10);
    const CableState state = pretensioned(cable);
    EXPECT_DOUBLE_EQ(state.displacement_m.front(), -10.0 * 2.0 / 2000.0);
    EXPECT_DOUBLE_EQ(state.displacement_m.back(), 0.0);
    for (int i = 0; i < cable.segments(); ++i) {
        const double elongation_m = state.displacement_m[i + 1] - state.displacement_m[i];
        EXPECT_NEAR(elongation_m, cable.segment_compliance_m_per_N(i) * 10.0, 1e-16);
    }
}

TEST(Cable, EveryProblemIsNamedAtOnce) {
    CableSpecification bad = test::paper_specification(0);
    bad.curvature = {{-2.0, 0.28}, {1.0, -0.1}};
    bad.axial_stiffness_N = 0.0;
    bad.dynamic_friction = -0.1;
    bad.static_friction = std::numeric_limits<double>::quiet_NaN();
    bad.pretension_N = std::numeric_limits<double>::infinity();
    const std::string text = refusal(bad);
    for (const char* name : {"curvature[1].length_m", "curvature[2].bend_radius_m", "segments",
                             "axial_stiffness_N", "dynamic_friction", "static_friction", "pretension_N"}) {
        EXPECT_NE(text.find(name), std::string::npos) << name << " not in: " << text;
    }
}

TEST(Cable, RejectsARoutingWithoutPiecesOrWithAPieceThatIsNotFinite) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CableSpecification bad = test::paper_specification(4);
    bad.curvature.clear();
    EXPECT_NE(refusal(bad).find("no piece"), std::string::npos);
    bad.curvature = {{straight, 0.28}};
    EXPECT_NE(refusal(bad).find("length_m"), std::string::npos);
    bad.curvature = {{2.0, nan}};
    EXPECT_NE(refusal(bad).find("bend_radius_m"), std::string::npos);
}

TEST(Cable, FrictionBeyondDoublePrecisionIsRefused) {
    CableSpecification spiral = test::paper_specification(10);
    spiral.curvature = {{100.0, 0.01}};
    EXPECT_NE(refusal(spiral).find("wrap angle"), std::string::npos);
}

TEST(Cable, StaticFrictionBelowDynamicIsRefused) {
    CableSpecification slippery = test::paper_specification(10);
    slippery.static_friction = 0.1;
    EXPECT_NE(refusal(slippery).find("static_friction"), std::string::npos);
}

}  // namespace
}  // namespace capstan
