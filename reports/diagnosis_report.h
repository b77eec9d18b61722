#pragma once
// The report of a diagnosis in every format, from its record in the database. The samples themselves are not
// kept, so its page has no curves; `capstan diagnose --html` has them.

#include <nlohmann/json.hpp>
#include <string>

#include "capstan/reports/experiment_page.h"
#include "capstan/storage/diagnosis_records.h"

namespace capstan::reports {

// The verdict and its probabilities, what was fitted, how far the gap shrinks, where it lies.
ExperimentPage diagnosis_page(const storage::DiagnosisRecord& diagnosis);

std::string diagnosis_html(const storage::DiagnosisRecord& diagnosis);
std::string diagnosis_markdown(const storage::DiagnosisRecord& diagnosis);

// One line per number: part, name, quantity, value, unit.
std::string diagnosis_csv(const storage::DiagnosisRecord& diagnosis);

// The keys of the published scoring (case, ranked, where, RMS before and after) and everything else.
nlohmann::ordered_json diagnosis_json(const storage::DiagnosisRecord& diagnosis);

}  // namespace capstan::reports
