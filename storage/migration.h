#pragma once
// How an older file becomes a current one.

#include <span>
#include <string>

#include "capstan/storage/database.h"

namespace capstan::storage {

// Leads from from_version to from_version + 1.
struct Migration {
    int from_version = 0;
    std::string sql;
};

std::span<const Migration> migrations();  // of this program, ascending

// Brings the file to target_version in one transaction, after leaving a copy of it as '<file>.version<k>'
// beside it. A file of target_version is not touched; a newer one is refused.
void migrate(Database& database, std::span<const Migration> steps, int target_version);

}  // namespace capstan::storage
