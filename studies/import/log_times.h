#pragma once

#include <string>
#include <string_view>

#include "capstan/logs/log.h"

namespace capstan::imports {

/// The column of times of a table: `wanted`, or one of the usual names; -1: there is none.
int time_column(const logs::LogTable& table, const std::string& wanted);

/// Seconds in one unit of a time column: of `stated`, else of the column's own unit, else of a unit at the
/// end of its name ("time_ms"), else 1.
double seconds_per_unit(const logs::LogColumn& column, const std::string& stated);

/// Whether a bench is sampled with this period: 15 Hz to 20 kHz.
bool is_usual_period(double period_s);

/// The unit in which a period has a usual length, the longest of s, ms, us, ns; empty: none of them.
std::string_view usual_time_unit(double period);

/// "ms" for 1e-3; empty for what is not a unit.
std::string_view time_unit_name(double seconds);

}  // namespace capstan::imports
