#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace capstan::imports {

/// A column of a log, and a few of its numbers for drawing it.
struct ListedColumn {
    std::string file;   ///< without folders
    std::string table;  ///< the topic, variable or sheet; empty where a file has one table
    std::string name;
    std::string unit;  ///< that the file states, or that its name ends in; empty: none
    std::size_t rows = 0;
    std::size_t missing = 0;  ///< rows without a number
    double low = 0.0;         ///< smallest number, in the column's unit; 0 where there is none
    double high = 0.0;
    /// The smallest and the largest number of each stretch of rows, in the order in which they stand.
    std::vector<double> drawn_row;    ///< from 0
    std::vector<double> drawn_value;  // as drawn_row
};

/// One file of several.
struct ListedLog {
    std::string file;
    std::string format;                ///< "MCAP"
    std::vector<std::string> remarks;  ///< what was not read, and what was taken for granted
    std::string same_columns_as;       ///< an earlier file; its columns are not listed again
};

struct ColumnList {
    std::vector<ListedLog> logs;
    std::vector<ListedColumn> columns;
};

/// The tables and columns of logs. Throws InvalidInput where a file is not a log.
ColumnList list_columns(
    const std::vector<std::filesystem::path>& files,
    const std::function<void(const std::string& activity, double fraction)>& on_progress = {});

}  // namespace capstan::imports
