#pragma once

#include <cstdint>
#include <vector>

#include "capstan/placement/fresh_errors.h"
#include "capstan/storage/database.h"
#include "capstan/storage/records.h"

namespace capstan {

/// What a designer trades: one more sensor must lower the error by this much [N] to be worth it.
struct RecommendationPolicy {
    double worthwhile_gain_N = 0.02;
};

/// Reads the cells of a study and says, per noise level, for each regime, by minimax regret across regimes
/// and by the duty cycle: which sensors, how many, which method, with the alternatives that paired
/// differences on the same draws cannot tell from the best. The best of many looks better than it is on the
/// draws that chose it, so a recommendation's error and interval are those of `fresh_errors`; the best of
/// each count beside it keeps the study's own draws, with an interval that holds for all choices of the count
/// together.
std::vector<storage::RecommendationRecord> recommend(storage::Database& database, std::int64_t study_id,
                                                     const RecommendationPolicy& policy,
                                                     const FreshErrors& fresh_errors);

/// What the draws that chose a recommendation say of it [N]. Its optimism is error_N less this.
double searched_error_N(const storage::RecommendationRecord& recommendation);

}  // namespace capstan
