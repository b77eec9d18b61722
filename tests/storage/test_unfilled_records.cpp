// A record that nobody has filled holds nothing: no number that could be taken for a result.

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <tuple>

#include "capstan/storage/diagnosis_store.h"
#include "capstan/storage/file_identity.h"
#include "capstan/storage/health.h"
#include "capstan/storage/migration.h"
#include "capstan/storage/record_rows.h"
#include "capstan/storage/study_ids.h"
#include "capstan/storage/study_store.h"

namespace capstan::storage {
namespace {

bool is_nothing(const std::string& text) {
    return text.empty();
}
bool is_nothing(const std::optional<double>& value) {
    return !value;
}
template <class Number>
bool is_nothing(Number number) {
    return number == 0;
}

// The names of the columns in which a new record holds something.
template <class Record>
std::string filled() {
    Record record{};
    std::string names;
    std::apply(
        [&](const auto&... column) {
            ((names += is_nothing(record.*column.member) ? "" : std::string(column.name) + " "), ...);
        },
        columns<Record>);
    return names;
}

TEST(UnfilledRecord, OfAStudyHoldsNothing) {
    EXPECT_EQ(filled<StudyRecord>(), "status ");
    EXPECT_EQ(StudyRecord{}.status, "running");
    EXPECT_EQ(StudyRecord{}.study_id, 0);
    EXPECT_EQ(filled<CableSegmentRecord>() + filled<RegimeRecord>() + filled<ScenarioNodeRecord>() +
                  filled<ScenarioRecord>() + filled<NoiseLevelRecord>() + filled<FusionMethodRecord>() +
                  filled<LayoutRecord>() + filled<WorldCandidateRecord>(),
              "");
    EXPECT_EQ(LayoutRecord{}.set_index, 0);
    EXPECT_EQ(WorkUnitRecord{}.scenario_index, 0);
    EXPECT_EQ(WorkUnitRecord{}.noise_index, 0);
    EXPECT_EQ(ShardRecord{}.shard, 0);
    EXPECT_EQ(ShardRecord{}.shards, 0);
}

TEST(UnfilledRecord, OfAResultHoldsNothing) {
    EXPECT_EQ(filled<SingleSensorNodeRecord>() + filled<SingleSensorRecord>() + filled<SensorWeightRecord>() +
                  filled<CellNodeRecord>() + filled<CellRecord>() + filled<KnownDirectionBoundRecord>() +
                  filled<WorldErrorRecord>(),
              "");
    EXPECT_EQ(SingleSensorResult{}.scenario_index, 0);
    EXPECT_EQ(SingleSensorResult{}.noise_index, 0);
    EXPECT_EQ(CellRecord{}.set_index, 0);
    EXPECT_EQ(KnownDirectionBoundRecord{}.set_index, 0);
    EXPECT_EQ(FusionResult{}.scenario_index, 0);
    EXPECT_EQ(FusionResult{}.noise_index, 0);
}

TEST(UnfilledRecord, OfAConclusionHoldsNothing) {
    EXPECT_EQ(filled<RecommendationCountRecord>() + filled<RecommendationAlternativeRecord>() +
                  filled<RecommendationRecord>() + filled<WorldRecommendationRecord>(),
              "");
    EXPECT_EQ(filled<PaperComparisonRecord>(), "relation ");
    EXPECT_EQ(PaperComparisonRecord{}.relation, "=");
    EXPECT_EQ(RecommendationCountRecord{}.set_index, 0);
    EXPECT_EQ(RecommendationAlternativeRecord{}.set_index, 0);
    EXPECT_EQ(RecommendationRecord{}.noise_index, 0);
    EXPECT_EQ(RecommendationRecord{}.set_index, 0);
}

// Of a bench that is as its description says the ratios to that description are 1.
TEST(UnfilledRecord, OfADiagnosisHoldsNothingButRatiosOfOne) {
    EXPECT_EQ(filled<DiagnosisRecord>(), "friction_ratio stiffness_ratio pretension_ratio ");
    const DiagnosisRecord diagnosis;
    EXPECT_EQ(diagnosis.friction_ratio, 1.0);
    EXPECT_EQ(diagnosis.stiffness_ratio, 1.0);
    EXPECT_EQ(diagnosis.pretension_ratio, 1.0);
    EXPECT_EQ(diagnosis.diagnosis_id, 0);
    EXPECT_EQ(filled<DiagnosisEffectRecord>() + filled<DiagnosisNumberRecord>() +
                  filled<DiagnosisCauseRecord>() + filled<DiagnosisCandidateRecord>() +
                  filled<DiagnosisChannelRecord>() + filled<DiagnosisGapRecord>(),
              "");
    EXPECT_EQ(DiagnosisSummary{}.diagnosis_id, 0);
    EXPECT_EQ(DiagnosisSummary{}.confidence_fraction, 0.0);
}

TEST(UnfilledRecord, OfASummaryHoldsNothing) {
    const StudySummary study{};
    EXPECT_EQ(study.study_id, 0);
    EXPECT_EQ(study.units_done + study.units, 0);
    const CellSummary cell{};
    EXPECT_EQ(cell.scenario_index, 0);
    EXPECT_EQ(cell.set_index, 0);
    EXPECT_EQ(cell.mean_abs_error_N, 0.0);
    EXPECT_EQ(cell.standard_error_N, 0.0);
    const LayoutErrorSummary error{};
    EXPECT_EQ(error.sensor_count, 0);
    EXPECT_EQ(error.mean_abs_error_N, 0.0);
    EXPECT_EQ(error.standard_error_N, 0.0);
    EXPECT_EQ(StudyIds{}.study_id, 0);
    EXPECT_EQ(FileIdentity{}.schema_version, 0);
    EXPECT_EQ(Migration{}.from_version, 0);
    const Health health{};
    EXPECT_EQ(health.studies + health.running_studies + health.diagnoses + health.cells + health.hashed_parts,
              0);
}

}  // namespace
}  // namespace capstan::storage
