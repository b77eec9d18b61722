#pragma once

#include <cstdint>

#include "capstan/plan/study_plan.h"
#include "capstan/storage/database.h"
#include "capstan/storage/records.h"

namespace capstan {

struct StoredStudy {
    storage::StudyDescription description;
    StudyPlan plan;  ///< as the stored configuration says
};

StoredStudy load_stored_study(storage::Database& database, std::int64_t study_id);

}  // namespace capstan
