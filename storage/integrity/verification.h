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
    double work_of_part = 0.0;          ///< as note_work() takes it
};

/// Works out every hash of the file again and compares. Changes nothing. At most 20 problems are named.
/// `work` is noted as it goes on.
HashCheck check_hashes(Database& database, double work = 0.0);

}  // namespace capstan::storage
