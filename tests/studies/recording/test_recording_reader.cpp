#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/recording/recording_writer.h"
#include "sample_recording.h"

namespace capstan::gap {
namespace {

// Geometry of driven_session().
const std::vector<double> true_parameters = {0.2, 0.4, 4000.0, 1.0};

std::string replaced(std::string text, const std::string& old_words, const std::string& new_words) {
    const std::size_t at = text.find(old_words);
    EXPECT_NE(at, std::string::npos) << old_words;
    return at == std::string::npos ? text : text.replace(at, old_words.size(), new_words);
}

// Line `number` (from 1) of a text, changed.
std::string with_line(const std::string& text, int number,
                      const std::function<std::string(std::string)>& change) {
    std::string out;
    std::size_t first = 0;
    for (int line = 1; first < text.size(); ++line) {
        const std::size_t end = text.find('\n', first);
        const std::string original = text.substr(first, end - first);
        out += (line == number ? change(original) : original) + "\n";
        first = end + 1;
    }
    return out;
}

TEST(RecordingReader, ReadsWhatWasRecorded) {
    const Recording measured = measured_session(true_parameters);
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.write(as_files(measured));
    std::filesystem::path sidecar = path;
    sidecar.replace_extension(".json");
    for (const auto& name : {path, sidecar}) {
        const Recording read = read_recording(name);
        ASSERT_EQ(read.runs.size(), 2u);
        EXPECT_EQ(read.samples(), measured.samples());
        EXPECT_EQ(read.runs[0].output, OutputKind::locked);
        EXPECT_EQ(read.runs[1].pretension_N, 6.0);
        EXPECT_EQ(read.nominal->axial_stiffness_N, 4000.0);
        ASSERT_EQ(read.nominal->curvature.size(), 2u);
        EXPECT_TRUE(std::isinf(read.nominal->curvature[0].bend_radius_m));
        for (const Channel& channel : measured.channels) {
            const auto found = static_cast<std::size_t>(*read.channel(channel.name));
            const auto original = static_cast<std::size_t>(*measured.channel(channel.name));
            EXPECT_NEAR(read.runs[1].values[found][77], measured.runs[1].values[original][77], 1e-8);
        }
    }
}

TEST(RecordingReader, ReadsTheConditionsOfARunAndWritesThemAgain) {
    RecordingFiles files = as_files(measured_session(true_parameters));
    files.sidecar_json = replaced(files.sidecar_json, "\"T0\": 6.0, ",
                                  "\"T0\": 6.0, \"condition\": {\"roll_deg\": -45, \"load\": 0.5}, ");
    const TemporaryFolder folder;
    const Recording read = read_recording(folder.write(files));
    EXPECT_TRUE(read.runs[0].conditions.empty());
    EXPECT_EQ(read.runs[1].conditions, (std::map<std::string, double>{{"load", 0.5}, {"roll_deg", -45.0}}));
    const std::filesystem::path copy = folder.write(files).parent_path() / "copy.csv";
    write_recording(copy, read);
    EXPECT_EQ(read_recording(copy).runs[1].conditions, read.runs[1].conditions);
}

TEST(RecordingReader, ARangeIsItsMiddleWithItsSpreadAndIsWrittenAgain) {
    RecordingFiles files = as_files(measured_session(true_parameters));
    files.sidecar_json = replaced(files.sidecar_json, "\"K\": 2000.0", "\"K\": [1000, 4000]");
    files.sidecar_json = replaced(files.sidecar_json, "\"T0\": 6.0", "\"T0\": [3, 12]");
    const TemporaryFolder folder;
    const Recording read = read_recording(folder.write(files));
    const double spread = std::log(4.0) / (2.0 * 1.96);  // a range holds 95%
    EXPECT_NEAR(read.nominal->axial_stiffness_N, 4000.0, 1e-9);
    EXPECT_NEAR(read.nominal->spread.stiffness, spread, 1e-4);
    EXPECT_NEAR(*read.runs[1].pretension_N, 6.0, 1e-9);
    EXPECT_NEAR(read.nominal->spread.pretension, spread, 1e-4);
    EXPECT_EQ(read.nominal->spread.friction, 0.0) << "it is stated as a value";
    const std::filesystem::path copy = folder.write(files).parent_path() / "copy.csv";
    write_recording(copy, read);
    EXPECT_NEAR(read_recording(copy).nominal->spread.stiffness, spread, 1e-4);
}

TEST(RecordingReader, NumbersThatNobodyStatesAreSoughtAndItSaysWhere) {
    RecordingFiles files = as_files(measured_session(true_parameters));
    files.sidecar_json = replaced(files.sidecar_json, "\"K\": 2000.0, ", "");
    for (const char* pretension : {"\"T0\": 4.0, ", "\"T0\": 6.0, "})
        files.sidecar_json = replaced(files.sidecar_json, pretension, "");
    const TemporaryFolder folder;
    const Recording read = read_recording(folder.write(files));
    EXPECT_GT(read.nominal->spread.stiffness, 1.0);
    EXPECT_GT(read.nominal->spread.pretension, 1.0);
    EXPECT_EQ(read.runs[0].pretension_N, read.runs[1].pretension_N);
    std::string said;
    for (const std::string& each : read.assumptions) said += each + "\n";
    EXPECT_NE(said.find("nominal.K or nominal.EA is missing"), std::string::npos) << said;
    EXPECT_NE(said.find("T0 of every run is missing"), std::string::npos) << said;
}

// A duration is a note, but one that the samples contradict is said.
TEST(RecordingReader, SaysWhereTheSamplesContradictAStatedDuration) {
    RecordingFiles files = as_files(measured_session(true_parameters));
    const TemporaryFolder folder;
    const auto said_of = [&](const std::string& duration) {
        RecordingFiles stated = files;
        stated.sidecar_json =
            replaced(files.sidecar_json, "\"T0\": 6.0, ", "\"T0\": 6.0, \"duration\": " + duration + ", ");
        return read_recording(folder.write(stated)).assumptions;
    };
    const Recording read = read_recording(folder.write(files));
    const double lasts_s = read.runs[1].time_s.back() - read.runs[1].time_s.front();
    EXPECT_EQ(said_of(std::to_string(1.05 * lasts_s)), read.assumptions);
    const std::vector<std::string> said = said_of(std::to_string(2.0 * lasts_s));
    ASSERT_EQ(said.size(), read.assumptions.size() + 1);
    EXPECT_NE(said.back().find("bench.json: the duration of run 2 is"), std::string::npos) << said.back();
}

struct Fault {
    const char* name;
    std::function<void(RecordingFiles&)> commit;
    std::vector<const char*> told;  ///< words of the message
};

class BadRecordings : public testing::TestWithParam<Fault> {};

TEST_P(BadRecordings, AreRefusedByNameWithTheirPlace) {
    RecordingFiles files = as_files(measured_session(true_parameters));
    GetParam().commit(files);
    const TemporaryFolder folder;
    try {
        read_recording(folder.write(files));
        FAIL() << "taken";
    } catch (const InvalidInput& error) {
        for (const char* words : GetParam().told)
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << words << "\n"
                                                                                << error.what();
    }
}

const Fault faults[] = {
    {"TruncatedLine",
     [](RecordingFiles& f) {
         f.samples_csv = with_line(f.samples_csv, 40, [](auto line) { return line.substr(0, 9); });
     },
     {"bench.csv:40", "values for 7 columns", "cut short"}},
    {"LastLineCutShort",
     [](RecordingFiles& f) { f.samples_csv.resize(f.samples_csv.size() - 20); },
     {"bench.csv:1201", "cut short"}},
    {"NotANumber",
     [](RecordingFiles& f) {
         f.samples_csv =
             with_line(f.samples_csv, 12, [](auto line) { return replaced(line, "1,0.1", "1,nan"); });
     },
     {"bench.csv:12", "column 't'", "'nan'", "not a finite number"}},
    {"PlaceholderOfALogger",
     [](RecordingFiles& f) {
         f.samples_csv = with_line(f.samples_csv, 12,
                                   [](auto line) { return line.substr(0, line.rfind(',')) + ",1e+30"; });
     },
     {"bench.csv:12", "1e+30", "no sensor reads"}},
    {"RunListedTwice",
     [](RecordingFiles& f) { f.sidecar_json = replaced(f.sidecar_json, "\"run\": 2", "\"run\": 1"); },
     {"runs[1].run", "is 1, as of an earlier run"}},
    {"TextInANumber",
     [](RecordingFiles& f) {
         f.samples_csv =
             with_line(f.samples_csv, 12, [](auto line) { return replaced(line, "1,0.1", "1,0.1s"); });
     },
     {"bench.csv:12", "0.1s"}},
    {"TimeGap",
     [](RecordingFiles& f) {
         f.samples_csv =
             with_line(f.samples_csv, 12, [](auto line) { return replaced(line, "1,0.1", "1,0.8"); });
     },
     {"bench.csv:12", "gap", "split the run"}},
    {"TimeRunsBackwards",
     [](RecordingFiles& f) {
         f.samples_csv =
             with_line(f.samples_csv, 12, [](auto line) { return replaced(line, "1,0.1", "1,0.01"); });
     },
     {"bench.csv:12", "does not come after"}},
    {"UnknownRun",
     [](RecordingFiles& f) {
         f.samples_csv =
             with_line(f.samples_csv, 12, [](auto line) { return replaced(line, "1,0.1", "7,0.1"); });
     },
     {"bench.csv:12", "run 7"}},
    {"MissingColumn",
     [](RecordingFiles& f) { f.samples_csv = replaced(f.samples_csv, "load_torque", "torque"); },
     {"bench.csv:1", "no column 'load_torque'", "column 'torque'"}},
    {"ForeignUnit",
     [](RecordingFiles& f) {
         f.sidecar_json = replaced(f.sidecar_json, "\"load_angle\": \"rad\"", "\"load_angle\": \"deg\"");
     },
     {"units.load_angle", "'deg'", "'rad'"}},
    {"SwappedRadii",
     [](RecordingFiles& f) {
         f.sidecar_json = replaced(f.sidecar_json, "\"r_input\": 0.02, \"r_load\": 0.1",
                                   "\"r_input\": 0.1, \"r_load\": 0.02");
     },
     {"motor_angle turns", "swapped"}},
    {"AllChannelsDriven",
     [](RecordingFiles& f) {
         f.sidecar_json =
             replaced(f.sidecar_json, "[\"motor_torque\", \"load_angle\"]",
                      "[\"motor_torque\", \"motor_angle\", \"load_angle\", \"load_torque\", \"tension_1\"]");
     },
     {"runs[0].driven", "every channel"}},
    {"UnknownDrivenChannel",
     [](RecordingFiles& f) {
         f.sidecar_json = replaced(f.sidecar_json, "[\"motor_torque\"", "[\"motor_tork\"");
     },
     {"runs[0].driven", "motor_tork"}},
    {"SensorOffTheCable",
     [](RecordingFiles& f) { f.sidecar_json = replaced(f.sidecar_json, "\"s\": 1.0", "\"s\": 2.4"); },
     {"tension_sensors[0].s", "outside"}},
    {"ProfileWithAHole",
     [](RecordingFiles& f) { f.sidecar_json = replaced(f.sidecar_json, "{\"s0\": 0.5,", "{\"s0\": 0.7,"); },
     {"R_profile[1].s0", "end at 0.5"}},
    {"NegativeStiffness",
     [](RecordingFiles& f) { f.sidecar_json = replaced(f.sidecar_json, "\"K\": 2000.0", "\"K\": -2000.0"); },
     {"nominal.K", "positive"}},
    {"StiffnessOfNoCable",
     [](RecordingFiles& f) { f.sidecar_json = replaced(f.sidecar_json, "\"K\": 2000.0", "\"K\": 1e300"); },
     {"nominal.K", "times L is", "1e+09 N", "another unit"}},
    {"RadiusInMillimetres",
     [](RecordingFiles& f) {
         f.sidecar_json = replaced(f.sidecar_json, "\"r_input\": 0.02", "\"r_input\": 20");
     },
     {"nominal.r_input", "is 20 m", "another unit"}},
    {"PretensionOfNoCable",
     [](RecordingFiles& f) { f.sidecar_json = replaced(f.sidecar_json, "\"T0\": 6.0", "\"T0\": 6e9"); },
     {"runs[1].T0", "is 6e+09 N", "another unit"}},
    {"FrictionOfNoSheath",
     [](RecordingFiles& f) { f.sidecar_json = replaced(f.sidecar_json, "\"mu_d\": 0.", "\"mu_d\": 90."); },
     {"nominal.mu_d", "no cable in a sheath"}},
    {"ARangeOfFrictionOfNoSheath",
     [](RecordingFiles& f) {
         f.sidecar_json = replaced(f.sidecar_json, "\"mu_d\": 0.2", "\"mu_d\": [20, 90]");
     },
     {"nominal.mu_d", "no cable in a sheath"}},
    {"MissingPretension",
     [](RecordingFiles& f) { f.sidecar_json = replaced(f.sidecar_json, "\"T0\": 6.0, ", ""); },
     {"runs[1].T0", "missing"}},
    {"ARangeUpsideDown",
     [](RecordingFiles& f) {
         f.sidecar_json = replaced(f.sidecar_json, "\"K\": 2000.0", "\"K\": [4000, 1000]");
     },
     {"nominal.K", "[low, high]"}},
    {"ConditionsAsAList",
     [](RecordingFiles& f) {
         f.sidecar_json = replaced(f.sidecar_json, "\"T0\": 6.0, ", "\"T0\": 6.0, \"condition\": [45], ");
     },
     {"runs[1].condition", "object of numbers", "roll_deg"}},
    {"AConditionInWords",
     [](RecordingFiles& f) {
         f.sidecar_json =
             replaced(f.sidecar_json, "\"T0\": 6.0, ",
                      "\"T0\": 6.0, \"condition\": {\"weather\": \"dry\", \"roll_deg\": null}, ");
     },
     {"runs[1].condition.weather", "one number", "runs[1].condition.roll_deg"}},
    {"BrokenJson",
     [](RecordingFiles& f) { f.sidecar_json = replaced(f.sidecar_json, "\"runs\": [", "\"runs\": "); },
     {"bench.json", "is not JSON", "line"}},
    {"UnknownMode",
     [](RecordingFiles& f) { f.sidecar_json = replaced(f.sidecar_json, "\"pull_pull\"", "\"push_pull\""); },
     {"mode", "push_pull", "did you mean"}},
    {"EmptyFile", [](RecordingFiles& f) { f.samples_csv.clear(); }, {"bench.csv", "no samples"}},
};

INSTANTIATE_TEST_SUITE_P(Faults, BadRecordings, testing::ValuesIn(faults),
                         [](const auto& fault) { return std::string(fault.param.name); });

TEST(RecordingReader, NamesAConstantChannel) {
    Recording measured = measured_session(true_parameters);
    for (RecordedRun& run : measured.runs) std::fill(run.values[4].begin(), run.values[4].end(), 3.0);
    const TemporaryFolder folder;
    EXPECT_THROW(
        {
            try {
                read_recording(folder.write(as_files(measured)));
            } catch (const InvalidInput& error) {
                EXPECT_NE(std::string(error.what()).find("'tension_1' never changes"), std::string::npos);
                throw;
            }
        },
        InvalidInput);
}

TEST(RecordingReader, TellsAProblemOfManyLinesOnceWithTheirNumber) {
    RecordingFiles files = as_files(measured_session(true_parameters));
    for (char& letter : files.samples_csv) {
        if (letter == '.') letter = ';';
    }
    const TemporaryFolder folder;
    try {
        read_recording(folder.write(files));
        FAIL() << "taken";
    } catch (const InvalidInput& error) {
        EXPECT_LT(error.problems().size(), 8u);
        EXPECT_NE(error.problems().front().find("lines, this is the first"), std::string::npos)
            << error.problems().front();
    }
}

TEST(RecordingReader, CutsALongListOfProblems) {
    ProblemList problems;
    for (int number = 0; number < 30; ++number) problems.add("bench.json", fmt::format("problem {}", number));
    try {
        problems.throw_if_any();
        FAIL() << "taken";
    } catch (const InvalidInput& error) {
        EXPECT_LT(error.problems().size(), 20u);
        EXPECT_NE(error.problems().back().find("18 more problems"), std::string::npos);
    }
}

TEST(RecordingReader, RejectsANumberBeyondDoubleRange) {
    const TemporaryFolder folder;
    try {
        read_recording(folder.write({"run,t\n1,0\n", R"({"sample_rate_hz": 1e999})"}));
        FAIL() << "taken";
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("1e999"), std::string::npos) << error.what();
    }
}

TEST(RecordingReader, ReadsTheFileOfASpreadsheet) {
    const Recording measured = measured_session(true_parameters);
    RecordingFiles files = as_files(measured);
    files.samples_csv.insert(0, "\xEF\xBB\xBF");  // the byte-order mark of UTF-8
    const TemporaryFolder folder;
    EXPECT_EQ(read_recording(folder.write(files)).samples(), measured.samples());
}

TEST(RecordingReader, NamesTheMissingFile) {
    try {
        read_recording("/no/such/bench.csv");
        FAIL() << "taken";
    } catch (const InvalidInput& error) {
        const std::string what = error.what();
        EXPECT_NE(what.find("/no/such/bench.csv: does not exist"), std::string::npos) << what;
        EXPECT_NE(what.find("NAME.json"), std::string::npos) << what;
    }
}

}  // namespace
}  // namespace capstan::gap
