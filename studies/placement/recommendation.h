#pragma once

#include <cstdint>
#include <vector>

#include "capstan/storage/database.h"
#include "capstan/storage/records.h"

namespace capstan {

/// What a designer trades: one more sensor must lower the error by this much [N] to be worth it.
struct RecommendationPolicy {
    double worthwhile_gain_N = 0.02;
};

/// Reads the cells of a study and says, per noise level, for each regime, by minimax regret across regimes
/// and by the duty cycle: which sensors, how many, which method, with intervals and with the alternatives
/// that paired differences on the same draws cannot tell from the best (max-t intervals over all
/// alternatives).
std::vector<storage::RecommendationRecord> recommend(storage::Database& database, std::int64_t study_id,
                                                     const RecommendationPolicy& policy);

}  // namespace capstan
