#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capstan/import/mapping.h"
#include "capstan/logs/log.h"

namespace capstan::imports {

/// The times of a table of a log: a column of times, or a stated rate.
struct Clock {
    const logs::LogTable* table = nullptr;
    int column = -1;              ///< in the table; -1: row / rate
    double seconds = 1.0;         ///< in one unit of the column
    double sample_rate_Hz = 0.0;  ///< where there is no column

    bool is(const Clock& other) const { return table == other.table && column == other.column; }
};

/// A channel's column and its clock in one run's logs.
struct Source {
    const ChannelMapping* mapping = nullptr;
    const logs::LogColumn* column = nullptr;
    Clock clock;
    double factor = 1.0;  ///< SI units in one of the column's
    double zero = 0.0;    ///< in the column's unit
    double clock_offset_s = 0.0;
    double wraps_at = 0.0;  ///< in the column's unit; 0: the counter does not wrap
};

/// Rows [first, end) of the tables, one uninterrupted stretch of log. Only a log with one table has several.
struct RowRange {
    std::size_t first = 0;
    std::size_t end = SIZE_MAX;
};

/// The usable readings of a channel in order: finite, each later than the one before, in SI units.
class Track {
  public:
    Track(const Source& source, RowRange rows);

    /// The next reading; false after the last.
    bool next(double& time_s, double& value);

    std::size_t missing = 0;   ///< rows without a number so far
    std::size_t repeated = 0;  ///< rows with the time of the row before
    std::size_t backward = 0;  ///< rows with an earlier time

  private:
    const Source* source_;
    RowRange rows_;
    std::size_t row_;
    std::optional<logs::NumberReader> times_;
    logs::NumberReader values_;
    double last_time_s_;
    double turns_ = 0.0;  ///< of the counter, in the column's unit
    double last_raw_;
};

/// The value of a track at rising times: a reading where there is one at that time, else on the straight line
/// between its neighbours.
class TrackAt {
  public:
    TrackAt(const Source& source, RowRange rows);

    /// NaN before the first reading and after the last.
    double at(double time_s);
    const Track& track() const { return track_; }

  private:
    Track track_;
    double before_s_;
    double before_;
    double after_s_;
    double after_;
};

/// The times of a clock in order, as the rows have them.
class ClockTimes {
  public:
    ClockTimes(const Clock& clock, RowRange rows);
    /// False after the last row; NaN where the row has no time.
    bool next(double& time_s);

  private:
    const Clock* clock_;
    RowRange rows_;
    std::size_t row_;
    std::optional<logs::NumberReader> times_;
};

/// The stretches of a log between changes of `run_column` (where there is one) and restarts of its clock: a
/// time that lies more than `restart_s` before the one before.
std::vector<RowRange> row_ranges(const Clock& clock, const logs::LogColumn* run_column);

}  // namespace capstan::imports
