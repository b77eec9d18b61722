#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capstan/placement/independent_errors.h"
#include "capstan/storage/database.h"
#include "capstan/storage/records.h"

namespace capstan {

/// One more sensor must lower the error by this much [N] to be recommended.
struct RecommendationPolicy {
    double worthwhile_gain_N;
    /// The error [N] without any sensor, by regime and of "duty_cycle"; empty: not known.
    std::map<std::string, double> no_sensor_N{};
};

/// Of a recommendation's regime or of the duty cycle; none for regrets, or where it is not known.
std::optional<double> no_sensor_error_N(const std::map<std::string, double>& no_sensor_N,
                                        const storage::RecommendationRecord& recommendation);

/// Whether sensors are better than none: not where the error without any lies within the interval of theirs
/// or below it.
bool beats_no_sensor(const storage::RecommendationRecord& recommendation, double no_sensor_N);

/// Reads the cells of a study and recommends, per noise level, for each regime, by minimax regret across
/// regimes and for the duty cycle: the number of sensors, their nodes and the fusion method, with the
/// alternatives that are not significantly worse in paired t tests on the same draws. The draws that
/// chose the best of many make it look better than it is, so a recommendation's error and interval are those
/// of `independent_errors`, on independent draws; the best of each count keeps the study's own draws, with an
/// interval that holds for all candidates of the count together.
std::vector<storage::RecommendationRecord> recommend(storage::Database& database, std::int64_t study_id,
                                                     const RecommendationPolicy& policy,
                                                     const IndependentErrors& independent_errors);

/// The error [N] on the draws that chose a recommendation. Their optimism is error_N less this.
double searched_error_N(const storage::RecommendationRecord& recommendation);

/// "at 1.8 m and 2.0 m (the load end)". Nodes are numbered from 1.
std::string place_words(const storage::StudyDescription& study, const std::vector<int>& nodes);

/// The recommendation in sentences: first which sensors to use and the expected error, then the settings, the
/// interval, the optimism of the search, the gain of one more sensor, and which other
/// choices were compared by which test. Where sensors are not better than none, it says so first.
std::string recommendation_sentence(const storage::StudyDescription& study,
                                    const storage::RecommendationRecord& recommendation,
                                    const RecommendationPolicy& policy);

}  // namespace capstan
