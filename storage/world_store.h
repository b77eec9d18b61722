#pragma once
// Studies with [uncertainty]: the errors of each set of sensors in each world, and what follows from them.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "capstan/storage/database.h"
#include "capstan/storage/records.h"

namespace capstan::storage {

// A set that a search tried beside those that the study began with; refused if there is one of this number.
void add_world_candidate(Database& database, std::int64_t study_id, int candidate_index,
                         const WorldCandidateRecord& candidate);

// All rows in one transaction; a row that is there already is refused.
void write_world_errors(Database& database, std::int64_t study_id, std::span<const WorldErrorRecord> errors);

// In the order of condition, candidate_index, world.
std::vector<WorldErrorRecord> read_world_errors(Database& database, std::int64_t study_id);

// Writes the recommendation and makes the study 'complete'. Refused the second time.
void finish_world_study(Database& database, std::int64_t study_id,
                        const WorldRecommendationRecord& recommendation);

// Nothing while the study is running.
std::optional<WorldRecommendationRecord> read_world_recommendation(Database& database, std::int64_t study_id);

}  // namespace capstan::storage
