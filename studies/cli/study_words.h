#pragma once

#include <cstdint>
#include <string>

#include "capstan/storage/database.h"

namespace capstan::cli {

/// What `capstan study show --json` writes.
std::string study_json(storage::Database& database, std::int64_t study_id);

}  // namespace capstan::cli
