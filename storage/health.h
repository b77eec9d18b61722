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
    int hashed_parts = 0;               // units and the like whose content hashes were compared
    std::vector<std::string> unhashed;  // studies and diagnoses from before schema version 6, which have none
    std::vector<std::string> copies;    // of older versions, beside the file
};

// Reads every page of the file, checks every reference and every content hash; takes a while on a large one.
// The database must have been opened for reading, with SchemaCheck::none. Where its schema is not ours,
// nothing else is read.
Health examine(Database& database);

// Where the tables, views and indices of an open file are not those that capstan makes, in words. The text of
// a view of another file could run without end, and a trigger write what nobody asked for. Further tables and
// views do no harm: nothing of ours reads them.
std::vector<std::string> schema_problems(Database& database);

}  // namespace capstan::storage
