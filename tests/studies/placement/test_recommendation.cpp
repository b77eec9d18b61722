// Cells made by hand, so that the best choice is plain to see.
#include <gtest/gtest.h>

#include <cmath>

#include "capstan/placement/recommendation.h"
#include "capstan/storage/study_store.h"
#include "temporary_study.h"

namespace capstan {
namespace {

constexpr int error_blocks = 40;

struct HandMadeSet {
    std::vector<int> nodes;  // from 1
    double mass_error_N;
    double partial_error_N;
};

// In mass motion two sensors halve the error of one and a third gains nothing; in partial motion the proximal
// sensor alone is best.
const std::vector<HandMadeSet> sets = {{{11}, 1.0, 0.5},
                                       {{1}, 2.0, 0.2},
                                       {{1, 11}, 0.5, 0.4},
                                       {{10, 11}, 0.502, 0.9},
                                       {{9, 10, 11}, 0.495, 0.395}};

// Eleven nodes, 0.2 m apart.
std::vector<storage::CableSegmentRecord> cable_segments() {
    std::vector<storage::CableSegmentRecord> segments;
    for (int i = 0; i < 10; ++i) segments.push_back({i + 1, 0.2 * i, 0.2, {}, 0.0});
    return segments;
}

storage::StudyDescription description() {
    storage::StudyDescription study;
    study.study = {0, "by hand", "", "test", 1, 400, 10, "running"};
    study.regimes = {{"mass", 0.75}, {"partial_proximal", 0.25}};
    for (const char* regime : {"mass", "partial_proximal"}) {
        storage::ScenarioRecord scenario;
        scenario.regime = regime;
        scenario.motion = "forward";
        study.scenarios.push_back(scenario);
    }
    study.cable_segments = cable_segments();
    study.noise_levels = {{"10 %", 0.1, 0.0, 0.0}};
    study.fusion_methods = {{"mean_known", "Mean, direction known", "direction_known", ""},
                            {"w_mean", "W Mean", "direction_unknown", ""}};
    for (const HandMadeSet& set : sets) study.sensor_sets.push_back({set.nodes});
    study.layouts = {{"both", "", 2, "Both, 2 sensors", 2}, {"distal", "", 2, "Distal, 2 sensors", 3}};
    study.work_units = {{"fusion", 0, 0}, {"fusion", 1, 0}};
    return study;
}

// Blocks spread by 0.012 N around the mean, each set in an order of its own.
storage::CellRecord cell(int set_index, const std::string& method, double error_N) {
    storage::CellRecord record;
    record.set_index = set_index;
    record.method = method;
    record.repetitions = 400;
    record.mean_abs_error_N = error_N;
    record.standard_error_N = 0.002;
    record.worst_node = 1;
    for (int b = 0; b < error_blocks; ++b) {
        record.block_mean_abs_error_N.push_back(error_N +
                                                0.001 * ((7 * b + 3 * set_index) % error_blocks - 19.5));
    }
    return record;
}

// On the hand-made independent draws every error is larger by this.
constexpr double optimism_N = 0.003;

std::vector<PlacementCandidate> independent_errors(int, std::vector<PlacementCandidate> chosen) {
    for (PlacementCandidate& candidate : chosen) {
        for (double& error_N : candidate.error_N) error_N += optimism_N;
        for (auto& scenario_N : candidate.block_error_N) {
            for (double& block_N : scenario_N) block_N += optimism_N;
        }
    }
    return chosen;
}

std::vector<storage::RecommendationRecord> recommended() {
    test::TemporaryStudy study;
    const std::int64_t id = storage::begin_study(study.database(), description());
    for (int scenario = 0; scenario < 2; ++scenario) {
        storage::FusionResult result{scenario, 0, {}, {}, {}};
        for (int s = 0; s < static_cast<int>(sets.size()); ++s) {
            result.cells.push_back(cell(s, "mean_known", 0.001));
            result.cells.push_back(
                cell(s, "w_mean", scenario == 0 ? sets[s].mass_error_N : sets[s].partial_error_N));
        }
        storage::write_fusion(study.database(), id, scenario, result);
    }
    return recommend(study.database(), id, {0.02}, independent_errors);
}

storage::RecommendationRecord find(const std::string& scope, const std::string& regime) {
    for (const auto& record : recommended()) {
        if (record.scope == scope && record.regime == regime) return record;
    }
    ADD_FAILURE() << "no recommendation for " << scope << " " << regime;
    return {};
}

TEST(Recommendation, CoversEachRegimeMinimaxRegretAndDutyCycle) {
    EXPECT_EQ(recommended().size(), 4u);
}

TEST(Recommendation, RecommendsTheCountWhereTheGainFlattens) {
    const auto mass = find("regime", "mass");
    EXPECT_EQ(mass.sensor_count, 2);
    EXPECT_EQ(mass.set_index, 2);
    EXPECT_EQ(mass.method, "w_mean") << "a method that needs the true direction is not a candidate";
    EXPECT_DOUBLE_EQ(mass.error_N, 0.5 + optimism_N) << "of the independent draws";
    EXPECT_DOUBLE_EQ(searched_error_N(mass), 0.5);
    // Student's t with 39 degrees of freedom; 40 equally spaced error_blocks.
    const double standard_error_N = 0.001 * std::sqrt(40.0 * 41.0 / 12.0 / 40.0);
    EXPECT_NEAR(mass.interval_high_N - mass.interval_low_N, 2.0 * 2.0227 * standard_error_N, 1e-6);
    ASSERT_EQ(mass.counts.size(), 3u);
    EXPECT_EQ(mass.counts[0].set_index, 0);
    EXPECT_EQ(mass.counts[1].set_index, 2);
    EXPECT_EQ(mass.counts[2].set_index, 4);

    // Two choices of two sensors were looked at: 2.5% on either side are 1.25% for each.
    EXPECT_NEAR(mass.counts[1].interval_high_N - mass.counts[1].error_N, 2.3313 * standard_error_N, 1e-6);
    EXPECT_NEAR(mass.counts[2].interval_high_N - mass.counts[2].error_N, 2.0227 * standard_error_N, 1e-6);

    const auto partial = find("regime", "partial_proximal");
    EXPECT_EQ(partial.sensor_count, 1);
    EXPECT_EQ(partial.set_index, 1);
}

// Nodes 10 and 11 are 0.002 N behind, with a standard error of the difference of about 0.003 N.
TEST(Recommendation, ListsAlternativesThatAreNotSignificantlyWorse) {
    const auto mass = find("regime", "mass");
    ASSERT_EQ(mass.alternatives.size(), 1u);
    EXPECT_EQ(mass.alternatives[0].set_index, 3);
    EXPECT_NEAR(mass.alternatives[0].difference_N, 0.002, 1e-12);
    EXPECT_LE(mass.alternatives[0].interval_low_N, 0.0);
    EXPECT_TRUE(find("regime", "partial_proximal").alternatives.empty());
}

// Regrets: mass 0.505, 1.505, 0.005, 0.007, 0; partial 0.3, 0, 0.2, 0.7, 0.195.
TEST(Recommendation, MinimaxRegretMinimisesTheLargestRegret) {
    const auto safe = find("minimax_regret", "");
    EXPECT_EQ(safe.set_index, 2);
    EXPECT_NEAR(safe.error_N, 0.2, 1e-12);
    ASSERT_EQ(safe.counts.size(), 3u);
    EXPECT_NEAR(safe.counts[0].error_N, 0.505, 1e-12);
    EXPECT_NEAR(safe.counts[2].error_N, 0.195, 1e-12);
}

TEST(Recommendation, DutyCycleWeightsRegimesByTheirTime) {
    const auto duty = find("duty_cycle", "");
    EXPECT_EQ(duty.set_index, 2);
    EXPECT_NEAR(duty.error_N, 0.75 * 0.5 + 0.25 * 0.4 + optimism_N, 1e-12);
}

void expect_parts(const std::string& sentence, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) {
        EXPECT_NE(sentence.find(part), std::string::npos) << part << " is not in: " << sentence;
    }
}

TEST(Recommendation, SentenceBeginsWithPlacesAndErrorThenStatesTheStatistics) {
    const std::string sentence = find("regime", "mass").sentence;
    EXPECT_EQ(sentence.rfind("Use 2 sensors, at 0.0 m (the motor end) and 2.0 m (the load end). "
                             "Expected tension error: 0.50 N. ",
                             0),
              0u)
        << sentence;
    expect_parts(
        sentence,
        {"motion of the entire cable with sensor noise 10 %", "sensors at nodes 1 and 11 (Both)", "by W Mean",
         "The 95% interval of the error is 0.499 to 0.507 N.",
         "the search's own draws were optimistic by 0.003 N.",
         "One more sensor would lower the error by 0.005 N (threshold for adding a "
         "sensor: 0.020 N).",
         "The study compared 2 of the 55 layouts with 2 sensors: the other is not significantly "
         "worse (paired t test on the study's draws at the 5% level, Bonferroni-corrected over the 1 "
         "other choice of layout and fusion method with as many sensors)."});
}

TEST(Recommendation, SentenceUsesTheSingularForOneSensor) {
    expect_parts(find("regime", "partial_proximal").sentence,
                 {"Use 1 sensor, at 0.0 m (the motor end).", "the sensor at node 1 and fuse",
                  "The study compared 2 of the 11 layouts with 1 sensor: the other is worse (paired t test"});
}

TEST(Recommendation, SentenceNamesWhatWasNotCompared) {
    storage::RecommendationRecord record = find("regime", "mass");
    storage::StudyDescription study = description();
    study.sensor_sets = {study.sensor_sets[2]};
    record.set_index = 0;
    record.alternatives.clear();
    expect_parts(recommendation_sentence(study, record, {0.02}),
                 {"No other choice with 2 sensors was compared."});
}

TEST(Recommendation, SentenceGivesTheGainOfSeveralSensorsAndOfEach) {
    storage::RecommendationRecord record = find("regime", "mass");
    ASSERT_EQ(record.counts.back().sensor_count, 3);
    record.counts.back().sensor_count = 5;  // the next count after 2
    record.counts.back().error_N = 0.44;
    expect_parts(recommendation_sentence(description(), record, {0.02}),
                 {"3 more sensors would lower the error by 0.060 N, 0.020 N for each (threshold for adding a "
                  "sensor: 0.020 N)."});
}

TEST(Recommendation, SaysWhereNoSensorIsAsGood) {
    const storage::RecommendationRecord record = find("regime", "mass");  // 0.503 N, 0.507 N at most
    EXPECT_TRUE(beats_no_sensor(record, 0.51));
    EXPECT_FALSE(beats_no_sensor(record, 0.505));
    expect_parts(recommendation_sentence(description(), record, {0.02, {{"mass", 0.51}}}),
                 {"Use 2 sensors, at", "Without any sensor it is 0.510 N."});
    expect_parts(
        recommendation_sentence(description(), record, {0.02, {{"mass", 0.505}}}),
        {"Use no sensor: the expected tension error without any is 0.505 N, and the sensors that the "
         "draws chose are not better: 0.503 N with 2 sensors",
         "With 3 sensors it would be 0.495 N, but each adds less than the threshold."});
    expect_parts(recommendation_sentence(description(), record, {0.02, {{"mass", 0.3}}}),
                 {"No studied number of sensors is."});
}

TEST(Recommendation, SentenceOfMinimaxRegretGivesTheExcessError) {
    expect_parts(find("minimax_regret", "").sentence,
                 {"exceeds that of the regime's best choice by at most 0.20 N.",
                  "all motion regimes together (minimax regret)", "The 95% interval of the excess is"});
}

}  // namespace
}  // namespace capstan
