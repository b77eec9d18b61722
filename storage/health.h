#pragma once
// The integrity check of a results file, and what the file holds.

#include <filesystem>
#include <string>
#include <vector>

#include "capstan/storage/database.h"

namespace capstan::storage {

struct Health {
    std::vector<std::string> problems;  // in words; none: the file is intact
    int studies = 0;
    int running_studies = 0;  // begun and not complete
    int diagnoses = 0;
    int cells = 0;
    std::vector<std::string> copies;  // of older versions, beside the file
};

// Reads every page of the file and checks every reference; takes a while on a large one. The database must
// have been opened for reading.
Health examine(Database& database);

}  // namespace capstan::storage
