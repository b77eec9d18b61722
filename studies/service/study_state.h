#pragma once

#include <cstdint>
#include <string>

#include "capstan/storage/database.h"

namespace capstan::service {

/// What everything that is said of a study depends on: its status and how many units are done.
struct StudyState {
    std::string words;
    bool is_complete = false;
};

/// A BadRequest (404) if there is no such study.
StudyState study_state(storage::Database& database, std::int64_t study_id);

}  // namespace capstan::service
