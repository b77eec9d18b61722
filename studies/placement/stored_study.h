#pragma once

#include <cstdint>
#include <string>

#include "capstan/placement/prepared_study.h"
#include "capstan/plan/study_plan.h"
#include "capstan/storage/database.h"
#include "capstan/storage/records.h"

namespace capstan {

/// A prepared study as the database keeps it. Work units: for each noise level the single-sensor stage of
/// every scenario, then the fusion stage of every scenario.
storage::StudyDescription describe(const PreparedStudy& study, const std::string& program_version);

struct StoredStudy {
    storage::StudyDescription description;
    StudyPlan plan;  ///< read from the stored configuration
};

StoredStudy load_stored_study(storage::Database& database, std::int64_t study_id);

/// The first difference between two stored studies, for an error message ("its seed is 2, not 1"); empty if
/// they are the same study. Their numbers in the file and their progress are not compared.
std::string difference_between(storage::StudyDescription one, storage::StudyDescription other);

}  // namespace capstan
