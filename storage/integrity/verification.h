#pragma once
// Whether what is stored is still what was written, by the hashes.

#include <string>
#include <vector>

#include "capstan/storage/database.h"

namespace capstan::storage {

struct HashCheck {
    int hashed = 0;  ///< parts (units, blocks of worlds, diagnoses, ...) that were compared
    std::vector<std::string> unhashed;  ///< studies and diagnoses from before schema version 6
    std::vector<std::string> problems;  ///< in words: which part of which study, and which table
};

/// Works out every hash of the file again and compares. Changes nothing. At most 20 problems are named.
HashCheck check_hashes(Database& database);

}  // namespace capstan::storage
