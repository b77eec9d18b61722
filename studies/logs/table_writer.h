#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "capstan/logs/log.h"

namespace capstan::logs {

/// Names that differ: of a name that is taken it makes `name.2`, `name.3`, ...
class UniqueNames {
  public:
    std::string operator()(const std::string& name);

  private:
    std::map<std::string, int> uses_;
};

/// Fills the tables of a log row by row and keeps to the limits: every reader writes through it. An infinite
/// number becomes a missing one. Throws InvalidInput that names the limit.
class TableWriter {
  public:
    TableWriter(Log& log, const ReadOptions& options) : log_(log), options_(options) {}

    /// A further table, empty. A name that is there already gets ".2".
    int add_table(const std::string& name);
    /// A further column of a table, NaN in the rows that are there; -1 if it is not wanted. A name that is
    /// there already gets ".2".
    int add_column(int table, const std::string& name, const std::string& unit = {});

    /// The next row of a table, to be filled: all NaN.
    std::vector<double>& row(int table) { return rows_[static_cast<std::size_t>(table)]; }
    void finish_row(int table);
    /// Further numbers of one column, where a file has column after column; set_rows() when all are there.
    void fill_column(int table, int column, std::span<const double> numbers);
    void set_rows(int table, std::size_t rows);

    /// Whether another column would be one too many.
    bool is_full() const { return columns_ >= LogLimits::columns; }
    Log& log() { return log_; }
    void assume(std::string sentence) { log_.assumptions.push_back(std::move(sentence)); }
    void remark(std::string sentence) { log_.remarks.push_back(std::move(sentence)); }

  private:
    void count_numbers(std::size_t count);

    Log& log_;
    const ReadOptions& options_;
    UniqueNames table_names_;
    std::vector<UniqueNames> column_names_;  ///< tables
    std::vector<std::vector<double>> rows_;  ///< tables x columns: the next row
    std::size_t columns_ = 0;
    std::size_t numbers_ = 0;
};

}  // namespace capstan::logs
