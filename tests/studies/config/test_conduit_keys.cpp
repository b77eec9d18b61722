// Conduits by pieces and bends, and the cut of the cable along them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "capstan/config/config_writer.h"
#include "problems_in.h"

namespace capstan::config {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

std::vector<CurvaturePiece> parse_bench_pieces(const std::string& toml) {
    return parse_plan<bench::BenchPlan>("kind = \"bench\"\n" + toml, "x.toml").plan.cable.curvature;
}

// A segment of the rule turns by little enough for the discretisation error.
TEST(ConduitKeys, SegmentsLeftOutWithUncertaintyFollowTheFriction) {
    const auto segments_with = [](double static_friction, const std::string& segments) {
        return parse_config("[transmission]\n" + segments + "dynamic_friction = 0.12\nstatic_friction = " +
                                std::to_string(static_friction) +
                                "\n[[transmission.curvature]]\nlength_m = 0.5\n[[transmission.curvature]]\n"
                                "length_m = 0.2\nbend_radius_m = 0.1\n[motion.distal]\nkind = \"position\"\n"
                                "[uncertainty]\nfar_end_range_m = 0.001\n",
                            "x.toml")
            .plan;
    };
    const StudyPlan smooth = segments_with(0.12, "");
    const StudyPlan sticky = segments_with(0.36, "");
    for (const StudyPlan& plan : {smooth, sticky}) {
        const Cable cable(plan.transmission.cable);
        const auto wrap_rad = cable.wrap_angle_rad();
        const double largest_rad = *std::max_element(wrap_rad.begin(), wrap_rad.end());
        EXPECT_LE(largest_rad * 0.12, 0.1);
        EXPECT_LE(largest_rad * (plan.transmission.cable.static_friction - 0.12), 0.03);
        EXPECT_EQ(plan.sensor_counts.size(), static_cast<std::size_t>(cable.nodes()));
    }
    EXPECT_GT(sticky.transmission.cable.segments, smooth.transmission.cable.segments);
    EXPECT_EQ(segments_with(4.0, "").transmission.cable.segments, 63);  // no more than can be estimated
    EXPECT_EQ(segments_with(0.24, "segments = 10\n").transmission.cable.segments, 10);
}

// Friction acts in bends alone: a short bend does not cut the straight conduit beside it as finely as itself.
TEST(ConduitKeys, SegmentsLeftOutWithUncertaintyLieInBends) {
    const std::string short_bend =
        "[transmission]\nlength_m = 1.0\ndynamic_friction = 0.3\n"
        "[[transmission.bend]]\nangle_deg = 180\nradius_m = 0.02\nat_m = 0.5\n"
        "[motion.distal]\nkind = \"position\"\n[uncertainty]\nfar_end_range_m = 0.001\n";
    const StudyPlan plan = parse_config(short_bend, "x.toml").plan;
    EXPECT_EQ(plan.transmission.cut, CableCut::in_bends);
    const Cable cable(plan.transmission.cable);
    EXPECT_EQ(cable.segments(), 12);  // ten of 18 degrees, and one on either side
    EXPECT_NEAR(cable.node_position_m(1), 0.5, 1e-12);
    for (int segment = 1; segment < 11; ++segment)
        EXPECT_NEAR(cable.wrap_angle_rad()[static_cast<std::size_t>(segment)], 0.1 * std::numbers::pi, 1e-9);
    const StudyPlan again = parse_config(config_text(plan, Comments::none), "again.toml").plan;
    EXPECT_EQ(again.transmission.cable.node_places_m, plan.transmission.cable.node_places_m);
    EXPECT_EQ(again.transmission.cut, CableCut::in_bends);
}

const std::string bent_arm = R"(
[transmission]
segments = 8
[[transmission.curvature]]
length_m = 0.3
[[transmission.curvature]]
length_m = 0.2
bend_radius_m = 0.1
[[transmission.curvature]]
length_m = 0.5
)";
const std::string of_unknown_friction = R"(
[uncertainty]
friction_fraction = 0.2
[[sensor]]
kind = "tension"
places_m = [0.0, 0.3, 0.7, 1.0]
noise_N = 0.1
)";

TEST(ConduitKeys, NodesLieAtBendsAndSensorsWhereWorldsAreDrawn) {
    const StudyPlan plan = parse_config(bent_arm + of_unknown_friction, "x.toml").plan;
    EXPECT_EQ(plan.transmission.cut, CableCut::at_bends);
    EXPECT_THAT(plan.transmission.cable.node_places_m, ElementsAre(0.3, 0.5, 0.7));
    EXPECT_EQ(
        parse_config(config_text(plan, Comments::none), "again.toml").plan.transmission.cable.node_places_m,
        plan.transmission.cable.node_places_m);
    const StudyPlan known = parse_config(bent_arm, "x.toml").plan;
    EXPECT_EQ(known.transmission.cut, CableCut::even);
    EXPECT_THAT(known.transmission.cable.node_places_m, ElementsAre());
}

TEST(ConduitKeys, TheCutThatIsStatedIsKept) {
    std::string even = bent_arm + of_unknown_friction;
    even.replace(even.find("segments = 8"), 12, "segments = 8\ncut = \"even\"");
    const StudyPlan plan = parse_config(even, "x.toml").plan;
    EXPECT_THAT(plan.transmission.cable.node_places_m, ElementsAre());
    EXPECT_EQ(parse_config(config_text(plan, Comments::none), "again.toml").plan.transmission.cut,
              CableCut::even);
    std::string at_bends = bent_arm;
    at_bends.replace(at_bends.find("segments = 8"), 12, "segments = 8\ncut = \"at_bends\"");
    EXPECT_THAT(parse_config(at_bends, "x.toml").plan.transmission.cable.node_places_m,
                ElementsAre(0.3, 0.5));
}

TEST(ConduitKeys, TooFewSegmentsForTheCutAreReportedAtTheirLine) {
    std::string few = bent_arm + of_unknown_friction;
    few.replace(few.find("segments = 8"), 12, "segments = 3");
    EXPECT_THAT(problems_in(few),
                ElementsAre(AllOf(StartsWith("3: transmission.segments"),
                                  HasSubstr("need at least 4 segments"), HasSubstr("\"even\""))));
    EXPECT_THAT(problems_in(bent_arm + "[placement]\nmax_in_distal_half = 1\n"), ElementsAre());
    std::string at_bends = bent_arm + "[placement]\nmax_in_distal_half = 1\n";
    at_bends.replace(at_bends.find("segments = 8"), 12, "segments = 8\ncut = \"at_bends\"");
    EXPECT_THAT(problems_in(at_bends), ElementsAre(HasSubstr("counts nodes")));
}

std::vector<CurvaturePiece> conduit_of(const std::string& toml) {
    return parse_config(toml, "x.toml").plan.transmission.cable.curvature;
}

TEST(ConduitKeys, APieceMayBeGivenByItsAngle) {
    const auto pieces = conduit_of(
        "[[transmission.curvature]]\nangle_deg = 90\nbend_radius_m = 0.08\n[[transmission.curvature]]\nlength_m = 0.3\n");
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_DOUBLE_EQ(pieces[0].length_m, 0.5 * std::numbers::pi * 0.08);
    EXPECT_EQ(pieces[0].bend_radius_m, 0.08);
    EXPECT_DOUBLE_EQ(
        parse_bench_pieces("[[cable.curvature]]\nangle_deg = 180\nbend_radius_m = 0.1\n")[0].length_m,
        std::numbers::pi * 0.1);
    const std::string at = "[[transmission.curvature]]\n";
    EXPECT_THAT(problems_in(at + "angle_deg = 90\n"),
                Contains(HasSubstr("only with bend_radius_m and without length_m")));
    EXPECT_THAT(problems_in(at + "angle_deg = 90\nlength_m = 0.2\nbend_radius_m = 0.1\n"),
                ElementsAre(StartsWith("2: transmission.curvature[1].angle_deg")));
    EXPECT_THAT(
        problems_in(at + "bend_radius_m = 0.1\n"),
        ElementsAre(AllOf(StartsWith("1: transmission.curvature[1].length_m"), HasSubstr("or an angle"))));
    EXPECT_THAT(problems_in(at + "angle_deg = -3\nbend_radius_m = 0.1\n"),
                ElementsAre(HasSubstr("must be above 0")));
}

TEST(ConduitKeys, AConduitMayBeGivenByItsBends) {
    const std::string bends = R"(
[transmission]
length_m = 1.2
[[transmission.bend]]
angle_deg = 90
radius_m = 0.08
at_m = 0.6
[[transmission.bend]]
angle_deg = 45
radius_m = 0.2
at_m = 0.1
)";
    const auto pieces = conduit_of(bends);
    ASSERT_EQ(pieces.size(), 5u);
    EXPECT_DOUBLE_EQ(pieces[0].length_m, 0.1);
    EXPECT_EQ(pieces[1].bend_radius_m, 0.2);
    EXPECT_DOUBLE_EQ(pieces[3].length_m, 0.5 * std::numbers::pi * 0.08);
    const std::string written = config_text(parse_config(bends, "x.toml").plan, Comments::none);
    EXPECT_THAT(conduit_of(written).size(), 5u);  // as pieces
    EXPECT_THAT(problems_in(bends + "[[transmission.curvature]]\nlength_m = 1\n"),
                ElementsAre(HasSubstr("beside other keys")));
    std::string overlapping = bends;
    overlapping.replace(overlapping.find("at_m = 0.1"), 10, "at_m = 0.7");
    EXPECT_THAT(problems_in(overlapping), ElementsAre(StartsWith("11: transmission.bend[2].at_m")));
    std::string endless = bends;
    endless.replace(endless.find("length_m = 1.2"), 14, "");
    EXPECT_THAT(problems_in(endless), ElementsAre(HasSubstr("needs transmission.length_m")));
    EXPECT_THAT(problems_in("[transmission]\n[[transmission.bend]]\nangle_deg = 90\nat_m = 0.1\n"),
                ElementsAre(StartsWith("2: transmission.bend[1].radius_m")));
}

}  // namespace
}  // namespace capstan::config
