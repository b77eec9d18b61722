#include "capstan/import/section.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace capstan::imports {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double never = -std::numeric_limits<double>::infinity();
// A log whose time falls by more than this began anew; a smaller fall is a row out of order.
constexpr double restart_s = 0.5;

std::optional<logs::NumberReader> times_of(const Clock& clock, std::size_t first) {
    if (clock.column < 0) return std::nullopt;
    return logs::NumberReader(clock.table->columns[static_cast<std::size_t>(clock.column)].values, first);
}

double time_of_row(const Clock& clock, std::optional<logs::NumberReader>& times, std::size_t row) {
    if (!times) return static_cast<double>(row) / clock.sample_rate_Hz;
    double number = nan;
    times->next(number);
    return number * clock.seconds;
}

}  // namespace

ClockTimes::ClockTimes(const Clock& clock, RowRange rows)
    : clock_(&clock), rows_(rows), row_(rows.first), times_(times_of(clock, rows.first)) {}

bool ClockTimes::next(double& time_s) {
    if (row_ >= std::min(rows_.end, clock_->table->rows)) return false;
    time_s = time_of_row(*clock_, times_, row_++);
    return true;
}

Track::Track(const Source& source, RowRange rows)
    : source_(&source),
      rows_(rows),
      row_(rows.first),
      times_(times_of(source.clock, rows.first)),
      values_(source.column->values, rows.first),
      last_time_s_(never),
      last_raw_(nan) {}

bool Track::next(double& time_s, double& value) {
    const std::size_t end = std::min(rows_.end, source_->clock.table->rows);
    while (row_ < end) {
        const double at_s = time_of_row(source_->clock, times_, row_++) + source_->clock_offset_s;
        double raw = nan;
        values_.next(raw);
        if (!std::isfinite(at_s) || !std::isfinite(raw)) {
            ++missing;
            continue;
        }
        if (at_s <= last_time_s_) {
            ++(at_s == last_time_s_ ? repeated : backward);
            continue;
        }
        if (source_->wraps_at > 0.0 && !std::isnan(last_raw_))
            turns_ -= source_->wraps_at * std::round((raw - last_raw_) / source_->wraps_at);
        last_raw_ = raw;
        last_time_s_ = at_s;
        time_s = at_s;
        value = source_->factor * (raw + turns_ - source_->zero);
        return true;
    }
    return false;
}

TrackAt::TrackAt(const Source& source, RowRange rows)
    : track_(source, rows), before_s_(never), before_(nan), after_s_(never), after_(nan) {
    if (!track_.next(after_s_, after_)) after_s_ = -never;
}

double TrackAt::at(double time_s) {
    while (after_s_ < time_s) {
        before_s_ = after_s_;
        before_ = after_;
        if (!track_.next(after_s_, after_)) after_s_ = -never;
    }
    if (after_s_ == time_s) return after_;
    if (std::isinf(after_s_) || std::isinf(before_s_)) return nan;
    return before_ + (after_ - before_) * ((time_s - before_s_) / (after_s_ - before_s_));
}

std::vector<RowRange> row_ranges(const Clock& clock, const logs::LogColumn* run_column) {
    std::vector<RowRange> ranges;
    std::size_t first = 0;
    double last_s = never;
    double last_run = nan;
    ClockTimes times(clock, {});
    std::optional<logs::NumberReader> runs;
    if (run_column != nullptr) runs.emplace(run_column->values);
    std::size_t row = 0;
    for (double time_s = 0.0; times.next(time_s); ++row) {
        double run = last_run;
        if (runs) runs->next(run);
        const bool other_run = std::isfinite(run) && std::isfinite(last_run) && run != last_run;
        if (row > first && (other_run || time_s < last_s - restart_s)) {
            ranges.push_back({first, row});
            first = row;
            last_s = never;
        }
        if (std::isfinite(time_s)) last_s = std::max(last_s, time_s);
        if (std::isfinite(run)) last_run = run;
    }
    if (row > first) ranges.push_back({first, row});
    return ranges;
}

}  // namespace capstan::imports
