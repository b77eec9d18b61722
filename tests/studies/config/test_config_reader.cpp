#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numbers>

#include "capstan/config/config_file.h"
#include "capstan/config/config_key.h"
#include "capstan/config/config_problem.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/config_writer.h"
#include "capstan/config/plan_checks.h"

namespace capstan::config {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

// "2: transmission.segmnets: unknown key; ..." for each problem.
std::vector<std::string> problems_in(const std::string& toml) {
    std::vector<std::string> texts;
    try {
        parse_config(toml, "x.toml");
    } catch (const ConfigError& error) {
        for (const ConfigProblem& problem : error.at_lines()) {
            texts.push_back(std::to_string(problem.line) + ": " + problem.key + ": " + problem.message);
        }
    }
    return texts;
}

std::vector<CurvaturePiece> parse_bench_pieces(const std::string& toml) {
    return parse_plan<bench::BenchPlan>("kind = \"bench\"\n" + toml, "x.toml").plan.cable.curvature;
}

TEST(ConfigReader, EmptyFileIsTheDefaultStudy) {
    const StudyPlan plan = parse_config("", "x.toml").plan;
    EXPECT_EQ(plan.transmission.cable.segments, 10);
    EXPECT_EQ(plan.sensor_counts.size(), 11u);
    EXPECT_THAT(problems_of(plan), ElementsAre());
}

TEST(ConfigReader, UnknownKeyIsNamedWithLineAndNearestName) {
    EXPECT_THAT(problems_in("seed = 2\n\n[transmission]\nsegmnets = 5\n"),
                ElementsAre("4: transmission.segmnets: unknown key; did you mean 'segments'?"));
    EXPECT_THAT(problems_in("[transmision]\n"),
                ElementsAre("1: transmision: unknown key; did you mean 'transmission'?"));
}

TEST(ConfigReader, KeyWithoutItsUnitIsUnknownAndTheFullNameIsOffered) {
    EXPECT_THAT(problems_in("[transmission]\npretension = 5\n"),
                ElementsAre(HasSubstr("did you mean 'pretension_N'?")));
    EXPECT_THAT(problems_in("[transmission]\nfriction = 0.1\n"),
                ElementsAre(HasSubstr("did you mean 'dynamic_friction'?")));
}

TEST(ConfigReader, StaticFrictionFollowsAStatedDynamicFriction) {
    const auto static_friction = [](const std::string& keys) {
        return parse_config("[transmission]\n" + keys, "x.toml").plan.transmission.cable.static_friction;
    };
    EXPECT_EQ(static_friction("dynamic_friction = 0.15\n"), 0.15);
    EXPECT_EQ(static_friction("dynamic_friction = 0.15\nstatic_friction = 0.3\n"), 0.3);
    EXPECT_EQ(static_friction(""), 0.63);
}

TEST(ConfigReader, KeyInTheWrongSectionIsReportedWithTheRightOne) {
    EXPECT_THAT(problems_in("pretension_N = 5\n"),
                ElementsAre(HasSubstr("it belongs to section [transmission]")));
}

TEST(ConfigReader, WrongTypeIsReportedWithTheExpectedType) {
    EXPECT_THAT(problems_in("repetitions = \"many\"\n"),
                ElementsAre("1: repetitions: is a string, but must be an integer"));
    EXPECT_THAT(problems_in("repetitions = 2.5\n"), ElementsAre(HasSubstr("is a number with a fraction")));
    EXPECT_THAT(problems_in("motion = 3\n"), ElementsAre(HasSubstr("must be a table")));
    EXPECT_THAT(problems_in("[noise]\nlabel = \"x\"\n"), ElementsAre(HasSubstr("[[noise]]")));
}

TEST(ConfigReader, NegativeLengthIsRefused) {
    EXPECT_THAT(problems_in("[[transmission.curvature]]\nlength_m = -2\n"),
                ElementsAre("2: transmission.curvature[1].length_m: is -2 m, but must be above 0"));
}

TEST(ConfigReader, SensorOutsideTheCableIsRefused) {
    EXPECT_THAT(problems_in("[layouts]\nexplicit = [[1, 12]]\n"),
                ElementsAre(StartsWith("2: layouts.explicit: a sensor at node 12 is outside the cable")));
    EXPECT_THAT(problems_in("[layouts]\nexplicit = [[0]]\n"),
                ElementsAre(StartsWith("2: layouts.explicit: is 0")));
}

TEST(ConfigReader, TwelveSensorsDoNotFitOnElevenNodes) {
    EXPECT_THAT(problems_in("[layouts]\ncounts = [1, 12]\n"),
                ElementsAre(StartsWith("2: layouts.counts: 12 sensors do not fit on 11 nodes")));
}

TEST(ConfigReader, SyntaxErrorHasLineAndColumn) {
    try {
        parse_config("seed = 1\nname = \n", "x.toml");
        FAIL() << "accepted";
    } catch (const ConfigError& error) {
        EXPECT_THAT(error.what(), StartsWith("x.toml:2:"));
        EXPECT_GT(error.at_lines().front().column, 0);
    }
}

TEST(ConfigReader, AllProblemsAreListedAtOnceInTheOrderOfLines) {
    EXPECT_THAT(
        problems_in(
            "nmae = \"x\"\nseed = -1\n[transmission]\naxial_stiffness_N = true\n[layouts]\ncounts = [12]\n"),
        ElementsAre(StartsWith("1: nmae"), StartsWith("2: seed"),
                    StartsWith("4: transmission.axial_stiffness_N"), StartsWith("6: layouts.counts")));
}

TEST(ConfigReader, MissingFileSuggestsCreatingOne) {
    try {
        read_config("no/such/file.toml");
        FAIL() << "accepted";
    } catch (const ConfigError& error) {
        EXPECT_THAT(error.what(), StartsWith("no/such/file.toml: no such file; `capstan config default"));
    }
}

TEST(ConfigReader, AmplitudeMustFitTheKindOfEnd) {
    EXPECT_THAT(problems_in("[motion.proximal]\nkind = \"tension\"\namplitude_m = 1\n"),
                ElementsAre(HasSubstr("has a meaning only with kind = \"position\" or \"spring\"")));
    EXPECT_THAT(problems_in("[motion.distal]\nkind = \"spring\"\n"),
                ElementsAre(HasSubstr("spring_stiffness_N_per_m: is missing")));
}

TEST(ConfigReader, NodesCountFromOneInTheFileAndFromZeroInside) {
    const StudyPlan plan = parse_config("[layouts]\nexplicit = [[1, 11]]\n", "x.toml").plan;
    EXPECT_THAT(plan.explicit_layouts, ElementsAre(ElementsAre(0, 10)));
}

TEST(ConfigReader, AllCountsFollowTheNumberOfNodes) {
    const StudyPlan plan = parse_config("[transmission]\nsegments = 3\n", "x.toml").plan;
    EXPECT_THAT(plan.sensor_counts, ElementsAre(1, 2, 3, 4));
}

// A segment of the rule turns by little enough for the discretisation error.
TEST(ConfigReader, SegmentsLeftOutWithUncertaintyFollowTheFriction) {
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
TEST(ConfigReader, SegmentsLeftOutWithUncertaintyLieInBends) {
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

TEST(ConfigReader, PieceWithoutRadiusIsStraight) {
    const StudyPlan plan = parse_config("[[transmission.curvature]]\nlength_m = 1\n", "x.toml").plan;
    EXPECT_EQ(plan.transmission.cable.curvature.at(0).bend_radius_m, straight);
}

TEST(ConfigReader, ProblemsOfTheStudyAreShownAtTheirLine) {
    const ReadConfig config =
        parse_config("[[regime]]\nname = \"mass\"\nsamples = [1]\nduty_fraction = 1\n", "x.toml");
    try {
        require_runnable(config);
        FAIL() << "accepted";
    } catch (const ConfigError& error) {
        EXPECT_THAT(error.what(), StartsWith("x.toml:3: "));
    }
}

// What resume and replay rely on.
template <class Plan>
void expect_round_trip(const Plan& plan) {
    const std::string text = config_text(plan, Comments::none);
    const Plan again = parse_plan<Plan>(text, "again").plan;
    EXPECT_EQ(config_text(again, Comments::none), text);
    for (const auto& section : config_schema<Plan>().sections) {
        const int rows = section.is_repeated() ? section.rows(plan) : 1;
        ASSERT_EQ(section.is_repeated() ? section.rows(again) : 1, rows) << section.path;
        for (const auto& key : config_schema<Plan>().keys) {
            for (int row = 0; key.section == section.path && row < rows; ++row) {
                EXPECT_EQ(key.read(again, row), key.read(plan, row)) << key.section << "." << key.name;
            }
        }
    }
}

TEST(ConfigWriter, PrintedDefaultReadsBackAsTheDefault) {
    const StudyPlan plan = default_plan();
    const StudyPlan again = parse_config(config_text(plan, Comments::every_key), "default").plan;
    EXPECT_EQ(config_text(again, Comments::none), config_text(plan, Comments::none));
    expect_round_trip(plan);
}

template <class Plan>
void expect_every_key_explained(const Plan& plan) {
    const std::string text = config_text(plan, Comments::every_key);
    for (const auto& key : config_schema<Plan>().keys) {
        // In use, or behind a comment sign where it does not apply.
        EXPECT_THAT(text, AnyOf(HasSubstr("\n" + key.name + " ="), HasSubstr("\n# " + key.name + " =")));
        EXPECT_FALSE(key.help.empty()) << key.name;
    }
}

TEST(ConfigWriter, PrintedDefaultExplainsEveryKey) {
    expect_every_key_explained(default_plan());
    expect_every_key_explained(default_bench());
}

TEST(ConfigWriter, AwkwardValuesRoundTrip) {
    StudyPlan plan = default_plan();
    plan.name = "a \"quoted\" \\ name\twith\nbreaks and \xc3\xa9";
    plan.seed = 9007199254740993;  // beyond the integers of double
    plan.transmission.cable.pretension_N = 0.1 + 0.2;
    plan.transmission.cable.axial_stiffness_N = 1e20;
    plan.transmission.cable.curvature.push_back({0.5, straight});
    plan.motion.distal = {EndKind::spring, 1e-7, 0.3, -1.5, 0.25, 2.5, 123.456};
    plan.motion.proximal = {EndKind::tension, 3.0, 0.5, 0.0, 0.0, 1e9, 0.0};
    plan.explicit_layouts = {{10, 0}, {4}};
    expect_round_trip(plan);
}

class ShippedConfig : public testing::TestWithParam<std::string> {};

TEST_P(ShippedConfig, ReadsBackAsItself) {
    const ReadConfig config = read_config(std::filesystem::path(CONFIGS_FOLDER) / GetParam());
    EXPECT_NO_THROW(require_runnable(config));
    expect_round_trip(config.plan);
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

TEST(ConfigReader, NodesLieAtBendsAndSensorsWhereWorldsAreDrawn) {
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

TEST(ConfigReader, TheCutThatIsStatedIsKept) {
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

TEST(ConfigReader, TooFewSegmentsForTheCutAreReportedAtTheirLine) {
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

TEST(ConfigReader, APieceMayBeGivenByItsAngle) {
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

TEST(ConfigReader, AConduitMayBeGivenByItsBends) {
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

std::vector<std::string> shipped_configs(ConfigContent content) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(CONFIGS_FOLDER)) {
        if (entry.path().extension() != ".toml") continue;
        if (content_of_config(entry.path()) == content) names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::string plain_name(const testing::TestParamInfo<std::string>& info) {
    std::string name = std::filesystem::path(info.param).stem().string();
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Configs, ShippedConfig, testing::ValuesIn(shipped_configs(ConfigContent::study)),
                         plain_name);

class ShippedBench : public testing::TestWithParam<std::string> {};

TEST_P(ShippedBench, ReadsBackAsItself) {
    expect_round_trip(read_bench(std::filesystem::path(CONFIGS_FOLDER) / GetParam()).plan);
}

INSTANTIATE_TEST_SUITE_P(Configs, ShippedBench, testing::ValuesIn(shipped_configs(ConfigContent::bench)),
                         plain_name);

}  // namespace
}  // namespace capstan::config
