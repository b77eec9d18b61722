#pragma once

#include <string>
#include <vector>

#include "capstan/import/section.h"
#include "capstan/import/survey.h"

namespace capstan::imports {

/// A column of a log with what can be seen of it.
struct SeenColumn {
    const logs::Log* log = nullptr;
    const logs::LogTable* table = nullptr;
    const logs::LogColumn* column = nullptr;
    std::string unit;  ///< that the file states, by a bracket or at the end of the name; empty: none
    std::vector<double> readings;  ///< the first ones, as they stand; a missing one repeats the one before
    double span = 0.0;
    double step = 0.0;  ///< of a lattice; 0: none
    bool integers_only = false;
    bool rising = false;  ///< from row to row: a time or a counter
};

/// Every column of the logs that is not constant.
std::vector<SeenColumn> seen_columns(const std::vector<const logs::Log*>& logs);

/// How well a column's name and unit fit a channel: 0 not at all, 1 as well as anything.
double name_fits(const SeenColumn& column, const std::string& channel);

/// True for what a controller asked for rather than what a sensor read.
bool is_command(const SeenColumn& column);

/// True for a number of the run that each row belongs to, by its name and its values.
bool is_run_number(const SeenColumn& column);

}  // namespace capstan::imports
