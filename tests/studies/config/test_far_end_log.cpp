#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "capstan/cable/invalid_input.h"
#include "capstan/config/config_problem.h"
#include "capstan/config/config_writer.h"
#include "capstan/config/far_end_log.h"

namespace capstan::config {
namespace {

const char* const arm = R"(
[motion]
sample_rate_Hz = 100
samples = 200

[uncertainty]
far_end = "recorded"
far_end_log = "wrist.csv"
)";

class FarEndLog : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("capstan_far_end_") +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
        write("arm.toml", arm);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }

    // A sine, at times that are not those of the configuration.
    void write_sine(double amplitude_m, double frequency_Hz, double duration_s) {
        std::string text = "time_s,displacement_m\n";
        for (double time_s = 3.0; time_s <= 3.0 + duration_s; time_s += 0.007)
            text += std::to_string(time_s) + "," +
                    std::to_string(amplitude_m * std::sin(2.0 * std::numbers::pi * frequency_Hz * time_s)) +
                    "\n";
        write("wrist.csv", text);
    }

    std::string refused() {
        try {
            read_config(folder_ / "arm.toml");
        } catch (const ConfigError& error) {
            return error.what();
        }
        return "nothing is wrong";
    }

    std::filesystem::path folder_;
};

TEST_F(FarEndLog, IsReadAtTheRateOfTheMotion) {
    write_sine(0.01, 0.5, 20.0);
    const Uncertainty unknown = read_config(folder_ / "arm.toml").plan.uncertainty;
    ASSERT_GT(unknown.far_end_samples_m.size(), 1990U);
    for (std::size_t k = 0; k < unknown.far_end_samples_m.size(); ++k)
        ASSERT_NEAR(unknown.far_end_samples_m[k],
                    0.01 * std::sin(std::numbers::pi * (3.0 + 0.01 * static_cast<double>(k))), 3e-6)
            << k;
}

TEST_F(FarEndLog, GivesTheRangeAndTheBandwidthUnlessTheyAreStated) {
    write_sine(0.01, 1.5, 60.0);
    const Uncertainty unknown = read_config(folder_ / "arm.toml").plan.uncertainty;
    EXPECT_NEAR(unknown.far_end_bandwidth_Hz, 1.5, 0.2);
    EXPECT_GT(unknown.far_end_range_m, 0.016);  // between the sine's turning points it is 0.02
    EXPECT_LT(unknown.far_end_range_m, 0.020);
    write("arm.toml", std::string(arm) + "far_end_range_m = 0.5\nfar_end_bandwidth_Hz = 7\n");
    const Uncertainty stated = read_config(folder_ / "arm.toml").plan.uncertainty;
    EXPECT_EQ(stated.far_end_range_m, 0.5);
    EXPECT_EQ(stated.far_end_bandwidth_Hz, 7.0);
}

TEST_F(FarEndLog, IsKeptInTheTextOfTheConfigurationToTheBit) {
    write_sine(0.01, 0.5, 20.0);
    const StudyPlan plan = read_config(folder_ / "arm.toml").plan;
    const StudyPlan again = parse_config(config_text(plan, Comments::none), "stored").plan;
    EXPECT_EQ(again.uncertainty.far_end_samples_m, plan.uncertainty.far_end_samples_m);
    EXPECT_EQ(again.uncertainty.far_end_range_m, plan.uncertainty.far_end_range_m);
    EXPECT_EQ(again.uncertainty.far_end_bandwidth_Hz, plan.uncertainty.far_end_bandwidth_Hz);
    EXPECT_EQ(again.uncertainty.far_end_log, "wrist.csv");
}

TEST_F(FarEndLog, ABadOneIsRefusedWithItsFileAndLine) {
    EXPECT_NE(refused().find("wrist.csv: cannot be read"), std::string::npos) << refused();
    EXPECT_NE(refused().find("arm.toml:8"), std::string::npos) << refused();
    write("wrist.csv", "time_s,displacement_m\n0,0\n1,0.001\n1,0.002\n5,0\n");
    EXPECT_NE(refused().find("wrist.csv:4: time_s is 1 after 1"), std::string::npos) << refused();
    write("wrist.csv", "time_s,displacement_m\n0,0\n1,nan\n5,0\n");
    EXPECT_NE(refused().find("wrist.csv:3: column 'displacement_m' has 'nan'"), std::string::npos)
        << refused();
    write("wrist.csv", "time_s,position\n0,0\n5,0\n");
    EXPECT_NE(refused().find("wrist.csv:1: has no column displacement_m"), std::string::npos) << refused();
    write_sine(0.01, 0.5, 1.5);
    EXPECT_NE(refused().find("but [motion] lasts 2 s"), std::string::npos) << refused();
    write("wrist.csv", "time_s,displacement_m\n0,0.001\n5,0.001\n");
    EXPECT_NE(refused().find("never changes"), std::string::npos) << refused();
    write("wrist.csv", "");
    EXPECT_NE(refused().find("no samples"), std::string::npos) << refused();
}

// The log is read when the rest is right; until then nothing is said of its samples.
TEST_F(FarEndLog, IsNotMissedWhereAnEarlierProblemKeptItFromBeingRead) {
    write_sine(0.01, 0.5, 20.0);
    write("arm.toml",
          std::string(arm) + "\n[transmission]\ncentre_line = \"no.csv\"\ncentre_line_noise_m = 1e-4\n");
    EXPECT_NE(refused().find("no.csv"), std::string::npos) << refused();
    EXPECT_EQ(refused().find("uncertainty.far_end"), std::string::npos) << refused();
}

TEST_F(FarEndLog, ATextAloneNeedsTheSamples) {
    try {
        parse_config(arm, "posted");
        FAIL();
    } catch (const ConfigError& error) {
        EXPECT_NE(std::string(error.what()).find("far_end_log"), std::string::npos);
    }
}

}  // namespace
}  // namespace capstan::config
