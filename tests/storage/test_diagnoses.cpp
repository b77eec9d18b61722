// A diagnosis that goes in comes out, in every field.
#include <gtest/gtest.h>

#include <limits>

#include "capstan/storage/diagnosis_store.h"
#include "capstan/storage/study_store.h"
#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

DiagnosisRecord example_diagnosis() {
    DiagnosisRecord record;
    record.recording = "bench";
    record.log_file = "it's/bench.csv";
    record.log_sha256 = std::string(64, 'a');
    record.program_version = "0.1.0";
    record.runs = "[1,3]";
    record.verdict = "backlash + drift";
    record.confidence_fraction = 0.48;
    record.component = "cable_a";
    record.cable_end = "motor";
    record.position_m = 0.25;
    record.worst_run = 3;
    record.worst_channel = "load_torque";
    record.friction_ratio = 1.01;
    record.stiffness_ratio = 0.99;
    record.pretension_ratio = 1.02;
    record.misfit_before_ratio = 12.5;
    record.misfit_after_ratio = 1.25;
    record.independent_samples_count = 431.5;
    record.sentence = "Two causes.";
    record.gap_sentence = "Mostly after reversals.";
    record.friction_low_ratio = 0.98;
    record.friction_high_ratio = 1.04;
    record.stiffness_low_ratio = 0.97;
    record.stiffness_high_ratio = 1.01;
    record.pretension_low_ratio = 1.01;
    record.pretension_high_ratio = 1.03;
    record.effects = {{"backlash", 0.48}, {"drift", 0.47}, {"unknown", 0.05}};
    record.causes = {{"backlash", "", "motor", "", std::nullopt, {{"half_width", 0.01, "rad", 0.008, 0.012}}},
                     {"drift",
                      "linear",
                      "sensor",
                      "motor",
                      0.25,
                      {{"ratio", 0.5, "", {}, {}}, {"slope", 2.0, "N/s", 1.5, 2.5}}}};
    record.candidates = {{R"(["backlash","drift"])", R"(["","linear"])", 3, 1.25, 0.5, "[3.0,2.5]", -40.0},
                         {R"(["none"])", R"([""])", 0, 12.5, 0.0, "[]", -900.0}};
    record.channels = {{"motor_angle", "rad", 1e-4, 2e-4, 1e-4, 1.1e-4, 1.5e-4, {}, {}, {}},
                       {"load_torque", "N m", 0.01, 0.5, 0.02, 0.03, 0.2, 0.98, 0.95, 0.99}};
    record.gap = {{"run", "1", 0.25, 0.1, 0.4, 0.5}, {"run", "3", 0.75, 0.6, 0.9, 0.5}};
    return record;
}

class Diagnoses : public testing::Test {
  protected:
    TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
};

TEST_F(Diagnoses, ComeBackAsTheyWereWritten) {
    DiagnosisRecord first = example_diagnosis();
    DiagnosisRecord second = example_diagnosis();
    second.recording = "another";
    second.causes.clear();
    first.diagnosis_id = write_diagnosis(database, first);
    second.diagnosis_id = write_diagnosis(database, second);
    EXPECT_EQ(list_diagnoses(database).size(), 2u);
    EXPECT_EQ(load_diagnosis(database, first.diagnosis_id), first);
    EXPECT_EQ(load_diagnosis(database, second.diagnosis_id), second);
}

TEST_F(Diagnoses, AreListedWithWhatTheyAreAbout) {
    const DiagnosisRecord written = example_diagnosis();
    const std::int64_t id = write_diagnosis(database, written);
    const auto listed = list_diagnoses(database);
    ASSERT_EQ(listed.size(), 1u);
    EXPECT_EQ(listed[0].diagnosis_id, id);
    EXPECT_EQ(listed[0].recording, written.recording);
    EXPECT_EQ(listed[0].log_file, written.log_file);
    EXPECT_EQ(listed[0].verdict, written.verdict);
    EXPECT_EQ(listed[0].confidence_fraction, written.confidence_fraction);
}

// Effects have places, from 1; what has an index is counted from 0.
TEST_F(Diagnoses, CountTheirPartsAsTheSchemaSays) {
    write_diagnosis(database, example_diagnosis());
    EXPECT_EQ(number_from(database, "SELECT min(place) FROM diagnosis_effect"), 1);
    EXPECT_EQ(number_from(database, "SELECT min(candidate_index) FROM diagnosis_candidate"), 0);
    EXPECT_EQ(number_from(database, "SELECT min(channel_index) FROM diagnosis_channel"), 0);
    EXPECT_EQ(number_from(database, "SELECT min(part_index) FROM diagnosis_gap"), 0);
}

TEST_F(Diagnoses, RejectAnUnknownNumber) {
    expect_says(error_of([&] { load_diagnosis(database, 7); }), "holds no diagnosis 7");
}

TEST_F(Diagnoses, AreJudgedByTheLoadTorqueInTheirView) {
    write_diagnosis(database, example_diagnosis());
    DiagnosisRecord without_load = example_diagnosis();
    without_load.channels.pop_back();
    write_diagnosis(database, without_load);
    Database reader = Database::open_read_only(folder / "results.db");
    const QueryResult result =
        run_read_only(reader, "SELECT channel, closed_fraction FROM v_diagnosis ORDER BY diagnosis_id");
    EXPECT_EQ(result.rows, (std::vector<std::vector<QueryValue>>{{std::string("load_torque"), 0.98},
                                                                 {std::string("motor_angle"), {}}}));
}

TEST_F(Diagnoses, StoreNothingIfAValueIsNotANumber) {
    DiagnosisRecord record = example_diagnosis();
    record.gap.back().energy_fraction = std::numeric_limits<double>::quiet_NaN();
    expect_says(error_of([&] { write_diagnosis(database, record); }), "diagnosis_gap.energy_fraction");
    EXPECT_TRUE(list_diagnoses(database).empty());
}

TEST_F(Diagnoses, ShareTheFileWithStudies) {
    write_diagnosis(database, example_diagnosis());
    delete_study(database, begin_study(database, example_study()));
    EXPECT_EQ(list_diagnoses(database).size(), 1u);
}

}  // namespace
}  // namespace capstan::storage
