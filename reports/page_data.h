#pragma once
// The study's tables as the page's scripts read them, safe inside a <script> element.

#include <string>

#include "capstan/reports/study_tables.h"

namespace capstan::reports {

// {"tables": {"name": {"meaning": ..., "columns": [...], "rows": [[...], ...]}}, "figures": {"id": spec},
//  "regime_titles": {...}}; numbers are rounded to six significant digits.
std::string page_data(const StudyTables& tables);

}  // namespace capstan::reports
