#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "capstan/config/config_file.h"
#include "capstan/config/config_key.h"
#include "capstan/config/config_problem.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/config_writer.h"
#include "capstan/config/plan_checks.h"
#include "problems_in.h"

namespace capstan::config {
namespace {

using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

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
