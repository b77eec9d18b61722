#pragma once

#include "capstan/placement/study_run.h"

namespace capstan {

/// Draws the conclusions of a study whose units are all stored (recommendations, the paper's table) and marks
/// it complete, in one transaction. Adds to `times`. Throws storage::Error while a unit is not done.
void conclude_study(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                    const RunOptions& options, StudyTimes& times);

}  // namespace capstan
