#pragma once

#include <filesystem>
#include <string>

#include "capstan/gap/diagnosis.h"
#include "capstan/recording/recording.h"
#include "capstan/storage/diagnosis_records.h"

namespace capstan::cli {

/// The names of the causes: 'backlash', 'backlash + drift', 'none' or 'unknown'.
std::string verdict_name(const gap::Diagnosis& diagnosis);

/// A diagnosis as the database keeps it, but for the log that it was made of.
storage::DiagnosisRecord diagnosis_record(const Recording& recording, const gap::Diagnosis& diagnosis);

/// Says which log it was made of, and what its bytes hash to.
void name_log(storage::DiagnosisRecord& record, const std::filesystem::path& log);

}  // namespace capstan::cli
