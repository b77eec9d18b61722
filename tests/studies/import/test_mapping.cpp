#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "capstan/cable/invalid_input.h"
#include "capstan/import/mapping.h"
#include "capstan/import/units.h"

namespace capstan::imports {

namespace {

using testing::HasSubstr;

std::string problems_of(const std::string& toml) {
    try {
        parse_mapping(toml, "import.toml");
        return "";
    } catch (const InvalidInput& error) {
        std::string all;
        for (const std::string& problem : error.problems()) all += problem + "\n";
        return all;
    }
}

TEST(Units, KnowTheSpellingsOfLaboratories) {
    EXPECT_DOUBLE_EQ(find_unit("degrees")->si, std::numbers::pi / 180.0);
    EXPECT_DOUBLE_EQ(find_unit("°")->si, std::numbers::pi / 180.0);
    for (const char* name : {"N m", "Nm", "N*m", "N·m", "NM", "n.m"}) {
        ASSERT_TRUE(find_unit(name)) << name;
        EXPECT_EQ(find_unit(name)->quantity, Quantity::torque) << name;
        EXPECT_EQ(find_unit(name)->si, 1.0) << name;
    }
    EXPECT_EQ(find_unit("mNm")->si, 1e-3);
    EXPECT_DOUBLE_EQ(find_unit("grams")->si, 9.80665e-3);
    EXPECT_EQ(find_unit("ns")->si, 1e-9);
    EXPECT_EQ(find_unit("MS")->quantity, Quantity::time);
    EXPECT_EQ(find_unit("counts")->quantity, Quantity::counts);
    EXPECT_FALSE(find_unit("furlong"));
    // Letters that differ in case are different units.
    EXPECT_EQ(find_unit("mN")->si, 1e-3);
    EXPECT_EQ(find_unit("m")->quantity, Quantity::length);
    EXPECT_EQ(find_unit("M"), std::nullopt);
}

TEST(Mapping, ScalesCountsCurrentsAndStatedFactors) {
    const Mapping mapping = parse_mapping(R"(
[channels]
motor_angle = { column = "a", unit = "counts", counts_per_turn = 4096, sign = -1 }
motor_torque = { column = "b", unit = "mA", torque_constant_Nm_per_A = 0.05 }
load_torque = { column = "c", unit = "counts", scale = 2e-4 }
)",
                                          "import.toml");
    EXPECT_DOUBLE_EQ(mapping.channels[0].factor(), -2.0 * std::numbers::pi / 4096.0);
    EXPECT_DOUBLE_EQ(mapping.channels[1].factor(), 5e-5);
    EXPECT_DOUBLE_EQ(mapping.channels[2].factor(), 2e-4);
}

TEST(Mapping, SurvivesBeingWrittenAndReadAgain) {
    const std::string text = R"(sample_rate_Hz = 100.0
thinning = "mean"
run_column = "trial \"7\""
time = { column = "Time, s", unit = "ms" }
text = { delimiter = ";", decimal_comma = true, head_line = 3, comments = "%" }

[channels]
motor_angle = { file = "a*.csv", table = "/joints", column = "position.x", unit = "deg", sign = -1, zero = 1.5, clock_offset_s = 0.02 }
tension_1 = { column = "3", unit = "g", wraps_at = 65536.0, noise_std = 0.1, step = 0.01 }

[recording]
mode = "single_cable"
nominal = { L = 2.0, R_profile = [{ s0 = 0, s1 = 2.0, R = 0.5 }] }

[[runs]]
files = ["a1.csv", "a2.csv"]
from_s = 1.0
to_s = 9.5
zero = { motor_torque = 338.56 }
T0 = 30.0
)";
    EXPECT_EQ(mapping_text(parse_mapping(text, "import.toml")), text);
}

TEST(Mapping, NamesEveryProblemWithItsLine) {
    const std::string all = problems_of(R"(sample_rate = 100
[channels]
motor_angle = { column = "a", unit = "degrees", sign = 2 }
load_angle = { column = "b", unit = "furlong" }
motor_torque = { column = "c", unit = "mA" }
load_torque = { column = "d", unit = "deg" }
tension_1 = { unit = "N" }
)");
    EXPECT_THAT(all,
                HasSubstr("import.toml:1: sample_rate: is not a key here; did you mean 'sample_rate_Hz'?"));
    EXPECT_THAT(all, HasSubstr("import.toml:3: channels.motor_angle.sign: should be 1 or -1"));
    EXPECT_THAT(all, HasSubstr("import.toml:4: channels.load_angle.unit: \"furlong\" is not known"));
    EXPECT_THAT(all, HasSubstr("torque_constant_Nm_per_A"));
    EXPECT_THAT(
        all,
        HasSubstr("import.toml:6: channels.load_torque.unit: \"deg\" is an angle, load_torque is a torque"));
    EXPECT_THAT(all, HasSubstr("import.toml:7: channels.tension_1.column: is missing"));
}

TEST(Mapping, SaysWhereTheTextIsNoToml) {
    EXPECT_THAT(problems_of("[channels\n"), HasSubstr("import.toml:1"));
}

}  // namespace

}  // namespace capstan::imports
