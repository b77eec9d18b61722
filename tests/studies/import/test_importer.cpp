#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "imported_folder.h"

namespace capstan::imports {

namespace {

using testing::HasSubstr;

constexpr double full_turn = 2.0 * std::numbers::pi;

// A drive at 100 Hz whose load follows the motor at half the angle, in degrees and mN m.
struct DriveLog {
    int rows = 400;
    double period = 0.01;
    std::string head = "Time [s];Motor angle [deg];Load angle [deg];Motor torque [mN m];Load torque [mN m]\n";

    static double motor_deg(double time_s) {
        return 40.0 * std::sin(full_turn * 0.5 * time_s) + 3.0 * time_s;
    }
    static double friction(double time_s) { return std::cos(full_turn * 0.5 * time_s) > 0.0 ? 20.0 : -20.0; }
    static std::string row(double shown_time, double time_s) {
        return fmt::format("{:.6g};{:.6f};{:.6f};{:.5f};{:.5f}\n", shown_time, motor_deg(time_s),
                           0.5 * motor_deg(time_s),
                           100.0 + friction(time_s) + 0.01 * std::sin(999.0 * time_s),
                           150.0 + 0.01 * std::cos(777.0 * time_s));
    }
    std::string text() const {
        std::string all = head;
        for (int k = 0; k < rows; ++k) all += row(k * period, k * period);
        return all;
    }
};

const std::string drive_mapping = R"(
time = { column = "Time" }
[channels]
motor_angle = { column = "Motor angle", unit = "deg" }
load_angle = { column = "Load angle", unit = "deg" }
motor_torque = { column = "Motor torque", unit = "mN m" }
load_torque = { column = "Load torque", unit = "mN m" }
[recording]
mode = "lumped_drive"
)";

using Importing = ImportTest;

TEST_F(Importing, ConvertsToSiAndKeepsTheLogsOwnSamples) {
    const ImportReport report = import({write("a.csv", DriveLog().text())}, drive_mapping);
    EXPECT_EQ(report.runs.size(), 1u);
    EXPECT_EQ(report.runs[0].samples, 400u);
    EXPECT_EQ(report.sample_rate_Hz, 100.0);
    for (const Finding& finding : report.findings) EXPECT_FALSE(finding.repaired) << finding.words;
    const Recording recording = imported();
    const RecordedRun& run = recording.runs[0];
    const auto motor = static_cast<std::size_t>(*recording.channel("motor_angle"));
    const auto torque = static_cast<std::size_t>(*recording.channel("motor_torque"));
    for (std::size_t k = 0; k < 400; ++k) {
        EXPECT_NEAR(run.values[motor][k],
                    DriveLog::motor_deg(0.01 * static_cast<double>(k)) * full_turn / 360.0, 1e-8);
        EXPECT_NEAR(run.values[torque][k], 0.1, 0.021);
    }
}

TEST_F(Importing, GivesTheSameBytesAgain) {
    const auto log = write("a.csv", DriveLog().text());
    import({log}, drive_mapping);
    const std::string samples = text_of("out.csv");
    const std::string sidecar = text_of("out.json");
    import({log}, drive_mapping);
    EXPECT_EQ(text_of("out.csv"), samples);
    EXPECT_EQ(text_of("out.json"), sidecar);
}

TEST_F(Importing, RefusesALogThatIsGivenTwice) {
    const auto log = write("a.csv", DriveLog().text());
    std::filesystem::create_symlink(log, folder_ / "b.csv");
    for (const auto& again : {log, folder_ / "." / "a.csv", folder_ / "b.csv"})
        EXPECT_THAT(refusal({log, again}, drive_mapping), HasSubstr("is given twice"));
    EXPECT_EQ(refusal({log, write("c.csv", DriveLog().text())}, drive_mapping), "");
}

TEST_F(Importing, DropsRepeatedSamplesAndSaysHowMany) {
    std::string text = DriveLog().head;
    for (int k = 0; k < 400; ++k) {
        text += DriveLog::row(0.01 * k, 0.01 * k);
        if (k % 100 == 50) text += DriveLog::row(0.01 * k, 0.01 * k);
    }
    const ImportReport report = import({write("a.csv", text)}, drive_mapping);
    const Finding finding = finding_of(report, FindingKind::repeated_samples);
    EXPECT_TRUE(finding.repaired);
    EXPECT_EQ(finding.count, 4u);
    EXPECT_EQ(imported().runs[0].samples(), 400);
}

TEST_F(Importing, SplitsARunAtAGapAndNumbersThePieces) {
    std::string text = DriveLog().head;
    for (int k = 0; k < 400; ++k) {
        if (k < 150 || k >= 180) text += DriveLog::row(0.01 * k, 0.01 * k);
    }
    const ImportReport report = import({write("a.csv", text)}, drive_mapping);
    EXPECT_EQ(finding_of(report, FindingKind::gap).count, 1u);
    const Recording recording = imported();
    ASSERT_EQ(recording.runs.size(), 2u);
    EXPECT_EQ(recording.runs[0].samples(), 150);
    EXPECT_EQ(recording.runs[1].samples(), 220);
    EXPECT_NEAR(recording.runs[1].session_start_s, 1.8, 1e-9);
}

TEST_F(Importing, BridgesFewMissingSamplesByStraightLines) {
    std::string text = DriveLog().head;
    for (int k = 0; k < 400; ++k) {
        if (k != 200 && k != 201) text += DriveLog::row(0.01 * k, 0.01 * k);
    }
    const ImportReport report = import({write("a.csv", text)}, drive_mapping);
    EXPECT_EQ(finding_of(report, FindingKind::missing_readings).count, 1u);
    const Recording recording = imported();
    ASSERT_EQ(recording.runs[0].samples(), 400);
    const auto motor = static_cast<std::size_t>(*recording.channel("motor_angle"));
    const double line =
        (DriveLog::motor_deg(1.99) + (DriveLog::motor_deg(2.02) - DriveLog::motor_deg(1.99)) / 3.0) *
        full_turn / 360.0;
    EXPECT_NEAR(recording.runs[0].values[motor][200], line, 1e-8);
}

// The jump over missing readings may have any size.
TEST_F(Importing, UnwindsACounterThatWrapsBesideAGap) {
    std::string text = "t,counts,load\n";
    for (int k = 0; k < 500; ++k) {
        const double angle = 0.5 * std::sin(full_turn * 0.5 * 0.01 * k);
        const double counts = std::round(angle / full_turn * 4096.0);
        if (k < 185 || k >= 235)
            text += fmt::format("{},{},{:.6f}\n", 0.01 * k, counts - 4096.0 * std::floor(counts / 4096.0),
                                0.8 * angle);
    }
    const ImportReport report = import({write("a.csv", text)}, R"(
[channels]
motor_angle = { column = "counts", unit = "counts", counts_per_turn = 4096 }
load_angle = { column = "load", unit = "rad" }
[recording]
mode = "lumped_drive"
)");
    EXPECT_EQ(finding_of(report, FindingKind::wrapped_counter).amount, 4096.0);
}

TEST_F(Importing, UnwindsACounterThatWraps) {
    std::string text = "t,counts,load\n";
    std::vector<double> true_rad;
    for (int k = 0; k < 500; ++k) {
        const double angle = 4.0 * std::sin(full_turn * 0.2 * 0.01 * k);
        const double counts = std::round(angle / full_turn * 4096.0);
        true_rad.push_back(counts / 4096.0 * full_turn);
        text += fmt::format("{},{},{:.6f}\n", 0.01 * k, counts - 4096.0 * std::floor(counts / 4096.0),
                            0.8 * angle);
    }
    const ImportReport report = import({write("a.csv", text)}, R"(
[channels]
motor_angle = { column = "counts", unit = "counts", counts_per_turn = 4096 }
load_angle = { column = "load", unit = "rad" }
[recording]
mode = "lumped_drive"
runs = []
[[runs]]
driven = ["motor_angle"]
)");
    EXPECT_EQ(finding_of(report, FindingKind::wrapped_counter).amount, 4096.0);
    const Recording recording = imported();
    const auto motor = static_cast<std::size_t>(*recording.channel("motor_angle"));
    for (std::size_t k = 0; k < true_rad.size(); ++k)
        EXPECT_NEAR(recording.runs[0].values[motor][k] - recording.runs[0].values[motor][0],
                    true_rad[k] - true_rad[0], 1e-7);
}

TEST_F(Importing, ShiftsTheClockOfAnotherFileByWhatTheMotionShows) {
    // The load is logged by another computer whose clock is 73 ms behind.
    std::string motor = "t,motor,torque\n";
    std::string load = "t,load\n";
    for (int k = 0; k < 900; ++k) {
        const double time_s = 0.01 * k;
        motor += fmt::format("{},{:.6f},{:.5f}\n", time_s, DriveLog::motor_deg(time_s),
                             DriveLog::friction(time_s) + 0.01 * std::sin(99.0 * k));
        load += fmt::format("{:.4f},{:.6f}\n", time_s - 0.073, 0.5 * DriveLog::motor_deg(time_s));
    }
    const std::string mapping = R"(
[channels]
motor_angle = { file = "motor.csv", column = "motor", unit = "deg" }
motor_torque = { file = "motor.csv", column = "torque", unit = "mN m" }
load_angle = { file = "load.csv", column = "load", unit = "deg" }
[recording]
mode = "lumped_drive"
[[runs]]
files = ["motor.csv", "load.csv"]
driven = ["motor_angle"]
)";
    const auto files = {write("motor.csv", motor), write("load.csv", load)};
    const ImportReport report = import(files, mapping);
    EXPECT_NEAR(finding_of(report, FindingKind::clock_offset).amount, 0.073, 0.001);
    const Recording recording = imported();
    const RecordedRun& run = recording.runs[0];
    const auto angle = static_cast<std::size_t>(*recording.channel("motor_angle"));
    const auto follower = static_cast<std::size_t>(*recording.channel("load_angle"));
    for (std::size_t k = 0; k < run.time_s.size(); ++k)
        EXPECT_NEAR(run.values[follower][k], 0.5 * run.values[angle][k], 1e-3);
    EXPECT_THAT(refusal(files, mapping, {.strict = true, .on_progress = {}}),
                HasSubstr("--strict repairs nothing"));
}

TEST_F(Importing, LeavesAStatedClockAlone) {
    std::string motor = "t,motor\n";
    std::string load = "t,load\n";
    for (int k = 0; k < 900; ++k) {
        motor += fmt::format("{},{:.6f}\n", 0.01 * k, DriveLog::motor_deg(0.01 * k));
        load += fmt::format("{:.4f},{:.6f}\n", 0.01 * k - 0.073, 0.5 * DriveLog::motor_deg(0.01 * k));
    }
    const ImportReport report = import({write("motor.csv", motor), write("load.csv", load)}, R"(
[channels]
motor_angle = { file = "motor.csv", column = "motor", unit = "deg" }
load_angle = { file = "load.csv", column = "load", unit = "deg", clock_offset_s = 0.01 }
[recording]
mode = "lumped_drive"
[[runs]]
files = ["motor.csv", "load.csv"]
driven = ["motor_angle"]
)");
    for (const Finding& finding : report.findings)
        EXPECT_NE(finding.kind, FindingKind::clock_offset) << finding.words;
}

TEST_F(Importing, ThinsByPickingOrByMeans) {
    DriveLog log;
    log.period = 0.001;
    log.rows = 4000;
    const auto file = write("a.csv", log.text());
    import({file}, "sample_rate_Hz = 100\n" + drive_mapping);
    const Recording picked = imported();
    import({file}, "sample_rate_Hz = 100\nthinning = \"mean\"\n" + drive_mapping);
    const Recording mean = imported();
    ASSERT_EQ(picked.runs[0].samples(), 400);
    ASSERT_EQ(mean.runs[0].samples(), 400);
    const auto motor = static_cast<std::size_t>(*picked.channel("motor_angle"));
    double sum = 0.0;
    for (int k = 0; k < 10; ++k) sum += DriveLog::motor_deg(0.1 + 0.001 * k) / 10.0;
    EXPECT_NEAR(picked.runs[0].values[motor][10], DriveLog::motor_deg(0.1) * full_turn / 360.0, 1e-8);
    EXPECT_NEAR(mean.runs[0].values[motor][10], sum * full_turn / 360.0, 1e-8);
}

TEST_F(Importing, TakesRunsFromAColumnWithTheirConditions) {
    std::string text = "trial,t,motor,load\n";
    for (int trial : {3, 5}) {
        for (int k = 0; k < 200; ++k)
            text += fmt::format("{},{},{:.6f},{:.6f}\n", trial, 0.01 * k, DriveLog::motor_deg(0.01 * k),
                                0.5 * DriveLog::motor_deg(0.01 * k));
    }
    import({write("a.csv", text)}, R"(
run_column = "trial"
[channels]
motor_angle = { column = "motor", unit = "deg" }
load_angle = { column = "load", unit = "deg" }
[recording]
mode = "lumped_drive"
[[runs]]
run = 3
protocol = "slow"
driven = ["motor_angle"]
[[runs]]
run = 5
protocol = "fast"
driven = ["motor_angle"]
condition = { roll_deg = -45 }
)");
    const Recording recording = imported();
    ASSERT_EQ(recording.runs.size(), 2u);
    EXPECT_EQ(recording.runs[0].number, 3);
    EXPECT_EQ(recording.runs[0].protocol, "slow");
    EXPECT_EQ(recording.runs[1].number, 5);
    EXPECT_EQ(recording.runs[1].protocol, "fast");
    EXPECT_TRUE(recording.runs[0].conditions.empty());
    EXPECT_EQ(recording.runs[1].conditions, (std::map<std::string, double>{{"roll_deg", -45.0}}));
}

TEST_F(Importing, LeavesAConstantChannelOut) {
    std::string text = "t,motor,load,dead\n";
    for (int k = 0; k < 300; ++k)
        text += fmt::format("{},{:.6f},{:.6f},0.5\n", 0.01 * k, DriveLog::motor_deg(0.01 * k),
                            0.5 * DriveLog::motor_deg(0.01 * k));
    const ImportReport report = import({write("a.csv", text)}, R"(
[channels]
motor_angle = { column = "motor", unit = "deg" }
load_angle = { column = "load", unit = "deg" }
motor_torque = { column = "dead", unit = "N m" }
[recording]
mode = "lumped_drive"
[[runs]]
driven = ["motor_angle"]
)");
    EXPECT_EQ(finding_of(report, FindingKind::constant_channel).channel, "motor_torque");
    EXPECT_FALSE(imported().channel("motor_torque"));
}

TEST_F(Importing, WritesNothingThatTheReaderWouldRefuse) {
    DriveLog log;
    log.rows = 10;  // too short for a run
    EXPECT_THAT(refusal({write("a.csv", log.text())}, drive_mapping), HasSubstr("fewer than 20"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.csv"));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.json"));
}

TEST_F(Importing, NeverOverwritesALog) {
    const auto log = write("out.csv", DriveLog().text());
    EXPECT_THAT(refusal({log}, drive_mapping), HasSubstr("is one of the logs"));
    EXPECT_EQ(text_of("out.csv"), DriveLog().text());
}

TEST_F(Importing, NamesAMissingColumnAndTheNearestOne) {
    std::string mapping = drive_mapping;
    mapping.replace(mapping.find("Load torque"), 11, "Load torqe");
    EXPECT_THAT(refusal({write("a.csv", DriveLog().text())}, mapping),
                HasSubstr("did you mean \"Load torque\"?"));
}

TEST_F(Importing, NamesTheTimesUnitThatNoBenchHas) {
    std::string mapping = drive_mapping;
    mapping.replace(mapping.find("{ column = \"Time\" }"), 19, "{ column = \"Time\", unit = \"ms\" }");
    const ImportReport report =
        try_import({write("a.csv", DriveLog().text())}, parse_mapping(mapping, "import.toml"));
    finding_of(report, FindingKind::time_unit);
}

TEST(RawGrasperLogs, GiveTheNumbersOfTheConvertedRecordingByATwentyLineMapping) {
    const std::filesystem::path data = std::filesystem::path(CAPSTAN_REAL_RECORDINGS) / "davinci-grip";
    if (!std::filesystem::exists(data / "raw")) GTEST_SKIP() << "no real recordings beside the repository";
    const std::string mapping = R"(sample_rate_Hz = 100
time = { column = "Back-end Time", unit = "s" }
[channels]
motor_angle = { column = "Back-end CUI Encoder", unit = "counts", counts_per_turn = 8192 }
motor_torque = { column = "Back-end Futek Torque", unit = "counts", scale = 3.9811e-05 }
motor_current = { column = "Measured Current", unit = "A" }
load_angle = { column = "Front-end Maxon Encoder", unit = "counts", counts_per_turn = 4000 }
load_torque = { column = "Front-end Futek Torque", unit = "counts", scale = 3.9811e-05 }
[recording]
mode = "lumped_drive"
[[runs]]
file = "Tool_4_Maryland_L_4_00.TXT"
[[runs]]
file = "Tool_4_Maryland_L_4_44.TXT"
)";
    EXPECT_LE(std::count(mapping.begin(), mapping.end(), '\n'), 25);
    const std::filesystem::path out = std::filesystem::temp_directory_path() / "capstan_raw_grasper";
    import_logs({data / "raw/Tool_4_Maryland_L_4_00.TXT", data / "raw/Tool_4_Maryland_L_4_44.TXT"},
                parse_mapping(mapping, "import.toml"), out);
    const Recording imported = read_recording(out.string() + ".csv");
    const Recording converted = read_recording(data / "tool4.csv");
    ASSERT_EQ(imported.runs.size(), 2u);
    const std::map<std::string, double> rounding = {{"motor_angle", 6e-6},
                                                    {"load_angle", 6e-6},
                                                    {"motor_torque", 6e-7},
                                                    {"load_torque", 6e-7},
                                                    {"motor_current", 1e-9}};
    for (const auto& [own, other] : {std::pair<std::size_t, int>{0, 1}, {1, 6}}) {
        const RecordedRun& mine = imported.runs[own];
        const auto theirs = std::find_if(converted.runs.begin(), converted.runs.end(),
                                         [&](const RecordedRun& run) { return run.number == other; });
        ASSERT_EQ(mine.samples(), theirs->samples());
        for (const Channel& channel : imported.channels) {
            const auto& a = mine.values[static_cast<std::size_t>(*imported.channel(channel.name))];
            const auto& b = theirs->values[static_cast<std::size_t>(*converted.channel(channel.name))];
            for (std::size_t k = 0; k < a.size(); ++k)
                ASSERT_NEAR(a[k], b[k], rounding.at(channel.name)) << channel.name << k;
        }
    }
    std::filesystem::remove(out.string() + ".csv");
    std::filesystem::remove(out.string() + ".json");
}

}  // namespace

}  // namespace capstan::imports
