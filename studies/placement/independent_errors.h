#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "capstan/placement/candidate_scores.h"
#include "capstan/plan/study_plan.h"
#include "capstan/storage/database.h"

namespace capstan {

/// The candidates again, in the same order, with their errors on draws that are independent of the choice.
using IndependentErrors = std::function<std::vector<PlacementCandidate>(
    int noise_index, const std::vector<PlacementCandidate>& chosen)>;

/// The independent draws are as many as the study's own, up to this number: then the standard error of a
/// choice is a hundredth of its spread, and merging a large study's shards on one machine takes minutes, not
/// hours.
inline constexpr int max_independent_repetitions = 10000;

/// Draws on addresses from `independent_draws` on, with the weights of the W methods that the stored study
/// had. `database` and `plan`, which the stored configuration describes, must outlive it; `jobs` as in
/// RunOptions.
IndependentErrors independent_errors(storage::Database& database, std::int64_t study_id,
                                     const StudyPlan& plan, int jobs);

}  // namespace capstan
