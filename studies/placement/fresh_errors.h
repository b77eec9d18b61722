#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "capstan/placement/candidate_scores.h"
#include "capstan/plan/study_plan.h"
#include "capstan/storage/database.h"

namespace capstan {

/// The candidates again, in the same order, with their errors on draws that no choice has seen.
using FreshErrors = std::function<std::vector<PlacementCandidate>(
    int noise_index, const std::vector<PlacementCandidate>& chosen)>;

/// Fresh draws are as many as the study's own, but no more than this: a choice is judged with an error of a
/// hundredth of its spread, and joining a large study's shards on one machine takes minutes, not hours.
inline constexpr int max_fresh_repetitions = 10000;

/// Draws on addresses from `fresh_draws` on, with the weights of the W methods that the stored study had.
/// `database` and `plan`, which the stored configuration describes, must outlive it; `jobs` as in RunOptions.
FreshErrors fresh_errors(storage::Database& database, std::int64_t study_id, const StudyPlan& plan, int jobs);

}  // namespace capstan
