#pragma once
// A page's tables and figures as the page's scripts read them, safe inside a <script> element.

#include <string>
#include <string_view>

#include "capstan/reports/table.h"

namespace capstan::reports {

// {"tables": {"name": {"meaning": ..., "columns": [...], "rows": [[...], ...]}}, "figures": {"id": spec},
//  "regime_titles": {...}}; numbers are rounded to six significant digits.
// Figures are those of the page of that name, see Figure::page.
std::string page_data(const Tables& tables, std::string_view page);

}  // namespace capstan::reports
