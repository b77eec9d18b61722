#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "capstan/config/config_reader.h"
#include "capstan/config/config_writer.h"
#include "problems_in.h"

namespace capstan::config {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;

// A configuration and its centre line in a folder.
class CentreLineKeys : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("capstan_centre_line_") +
                   testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    ReadConfig read(const std::string& toml) const {
        write("x.toml", toml);
        return read_config(folder_ / "x.toml");
    }
    std::vector<std::string> problems_in(const std::string& toml) const {
        return problems_of_reading([&] { read(toml); });
    }

    std::filesystem::path folder_;
};

// A quarter turn of radius 0.1 m between straight ends of 0.2 m, to a micrometre.
std::string quarter_turn_csv() {
    std::string csv = "x_m,y_m,z_m\n";
    const double bend_m = 0.05 * std::numbers::pi;
    for (double s = 0.0; s < 0.4 + bend_m; s += 0.005) {
        const double turned = std::clamp((s - 0.2) / 0.1, 0.0, 0.5 * std::numbers::pi);
        const double x_m = std::min(s, 0.2) + 0.1 * std::sin(turned);
        const double y_m = 0.1 * (1.0 - std::cos(turned)) + std::max(s - 0.2 - bend_m, 0.0);
        char line[96];
        std::snprintf(line, sizeof line, "%.6f,%.6f,0.3\n", x_m, y_m);
        csv += line;
    }
    return csv;
}
const std::string with_line = R"([transmission]
centre_line = "arm.csv"
centre_line_noise_m = 1e-4
)";

TEST_F(CentreLineKeys, GiveTheConduitItsPiecesAndTheirUncertainty) {
    write("arm.csv", quarter_turn_csv());
    const StudyPlan plan = read(with_line + "[uncertainty]\n").plan;
    const auto& pieces = plan.transmission.cable.curvature;
    ASSERT_EQ(pieces.size(), 3u);
    EXPECT_NEAR(pieces[1].length_m / pieces[1].bend_radius_m, 0.5 * std::numbers::pi, 0.03);
    EXPECT_NE(plan.uncertainty.wrap_fraction, Uncertainty{}.wrap_fraction);
    EXPECT_GT(plan.uncertainty.wrap_fraction, 0.0);
    EXPECT_LT(plan.uncertainty.wrap_fraction, 0.15);
    EXPECT_THAT(plan.transmission.cable.node_places_m,  // the bend begins and ends at nodes
                IsSupersetOf({pieces[0].length_m, pieces[0].length_m + pieces[1].length_m}));
    EXPECT_THAT(plan.transmission.conduit_note, AllOf(HasSubstr("arm.csv: "), HasSubstr("wrap angle 1.5"),
                                                      HasSubstr("+- "), HasSubstr("bends: ")));
}

TEST_F(CentreLineKeys, AreWrittenAsPiecesThatNeedNoFile) {
    write("arm.csv", quarter_turn_csv());
    const StudyPlan plan = read(with_line + "[uncertainty]\n").plan;
    const StudyPlan again = parse_config(config_text(plan, Comments::none), "stored").plan;
    ASSERT_EQ(again.transmission.cable.curvature.size(), 3u);
    EXPECT_EQ(again.transmission.cable.curvature[1].bend_radius_m,
              plan.transmission.cable.curvature[1].bend_radius_m);
    EXPECT_EQ(again.uncertainty.wrap_fraction, plan.uncertainty.wrap_fraction);
    EXPECT_EQ(again.transmission.conduit_note, plan.transmission.conduit_note);
    EXPECT_EQ(config_text(again, Comments::none), config_text(plan, Comments::none));
}

TEST_F(CentreLineKeys, KeepAStatedUncertainty) {
    write("arm.csv", quarter_turn_csv());
    EXPECT_EQ(read(with_line + "[uncertainty]\nwrap_fraction = 0.3\n").plan.uncertainty.wrap_fraction, 0.3);
    EXPECT_EQ(read(with_line).plan.uncertainty.is_stated, false);
}

TEST_F(CentreLineKeys, NameFileAndLineOfBadPoints) {
    const auto problem_of = [&](const std::string& csv) {
        write("arm.csv", csv);
        const auto problems = problems_in(with_line);
        return problems.size() == 1 ? problems.front() : std::to_string(problems.size()) + " problems";
    };
    EXPECT_THAT(problem_of("x_m,y_m\n0,0\n0.1,0\n"),
                AllOf(HasSubstr("2: transmission.centre_line"), HasSubstr("arm.csv:1"),
                      HasSubstr("no column 'z_m'")));
    EXPECT_THAT(problem_of("x_m,y_m,z_m\n0,0,0\n0.1,nan,0\n"),
                AllOf(HasSubstr("arm.csv:3"), HasSubstr("'nan'")));
    EXPECT_THAT(problem_of("x_m,y_m,z_m\n0,0,0\n0.1,0,0\n0.1,0,0\n"),
                AllOf(HasSubstr("arm.csv:4"), HasSubstr("same point")));
    EXPECT_THAT(problem_of("x_m,y_m,z_m\n0,0,0\n0.1,0,0\n0.2,0,0\n"),
                AllOf(HasSubstr("arm.csv"), HasSubstr("at least 8")));
    std::filesystem::remove(folder_ / "arm.csv");
    EXPECT_THAT(problems_in(with_line),
                ElementsAre(AllOf(HasSubstr("arm.csv"), HasSubstr("cannot be read"))));
}

TEST_F(CentreLineKeys, AreRefusedBesideOtherWaysAndWithoutTheirNoise) {
    write("arm.csv", quarter_turn_csv());
    EXPECT_THAT(problems_in("[transmission]\ncentre_line = \"arm.csv\"\n"),
                ElementsAre(AllOf(HasSubstr("2: "), HasSubstr("needs centre_line_noise_m"))));
    EXPECT_THAT(problems_in("[transmission]\ncentre_line_noise_m = 1e-4\n"),
                ElementsAre(HasSubstr("only with centre_line")));
    EXPECT_THAT(problems_in(with_line + "[[transmission.curvature]]\nlength_m = 1\n"),
                ElementsAre(HasSubstr("beside other keys")));
    EXPECT_THAT(problems_in(with_line + "length_m = 1\n"), ElementsAre(HasSubstr("beside other keys")));
}

// The service takes configurations from untrusted input.
TEST_F(CentreLineKeys, OfATextWithoutAFolderReadNoFile) {
    try {
        parse_config("[transmission]\ncentre_line = \"/etc/hostname\"\ncentre_line_noise_m = 1e-4\n",
                     "posted");
        FAIL();
    } catch (const ConfigError& error) {
        EXPECT_THAT(error.what(), HasSubstr("only a configuration in a file of its own"));
    }
}

}  // namespace
}  // namespace capstan::config
