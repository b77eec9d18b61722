#pragma once
// Diagnoses of recordings, written once and read back. They stand beside the studies: neither refers to the
// other.

#include <cstdint>
#include <string>
#include <vector>

#include "capstan/storage/database.h"
#include "capstan/storage/diagnosis_records.h"

namespace capstan::storage {

// One transaction. Returns the diagnosis_id; that of the record is not read. An Error names a value that is
// not a number.
std::int64_t write_diagnosis(Database& database, const DiagnosisRecord& diagnosis);

struct DiagnosisSummary {
    std::int64_t diagnosis_id = 0;
    std::string recording;
    std::string log_file;
    std::string verdict;
    double confidence_fraction = 0;
};

std::vector<DiagnosisSummary> list_diagnoses(Database& database);  // oldest first

// One diagnosis. An Error if its number does not exist.
DiagnosisRecord load_diagnosis(Database& database, std::int64_t diagnosis_id);

}  // namespace capstan::storage
