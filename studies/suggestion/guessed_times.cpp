#include "capstan/suggestion/guessed_times.h"

#include <fmt/format.h>

#include "capstan/import/log_times.h"
#include "capstan/import/units.h"
#include "capstan/platform/statistics.h"

namespace capstan::imports {

namespace {

// A unit in which the rate is usual for a bench: the stated one, if it is.
void settle_time_unit(TimeMapping& time, const logs::LogColumn& column, std::vector<Guess>& guesses) {
    const double stated = seconds_per_unit(column, "");
    const std::vector<double> readings = logs::numbers_of(column.values, 4096);
    std::vector<double> periods;
    for (std::size_t k = 1; k < readings.size(); ++k) {
        if (readings[k] > readings[k - 1]) periods.push_back(readings[k] - readings[k - 1]);
    }
    if (periods.empty()) return;
    const double period = upper_median(periods);
    if (is_usual_period(period * stated)) {
        time.unit = time_unit_name(stated);
        return;
    }
    time.unit = usual_time_unit(period);
    if (time.unit.empty()) return;
    guesses.push_back(
        {"time", Doubt::likely,
         fmt::format("in {} the rate is {:.4g} Hz; in {} it would be {:.4g} Hz, unusual for a bench",
                     time.unit, 1.0 / (period * find_unit(time.unit)->si),
                     column.unit.empty() ? "s" : "\"" + column.unit + "\", as the head says,",
                     1.0 / (period * stated))});
}

}  // namespace

std::set<const logs::LogColumn*> guess_times(TimeMapping& time, const std::vector<SeenColumn>& columns,
                                             std::vector<Guess>& guesses) {
    std::set<const logs::LogColumn*> times;
    std::vector<const logs::LogTable*> tables;  // in the order of the files
    for (const SeenColumn& column : columns) {
        if (tables.empty() || tables.back() != column.table) tables.push_back(column.table);
    }
    for (const logs::LogTable* table : tables) {
        int found = time_column(*table, "");
        const bool by_name = found >= 0;
        for (const SeenColumn& column : columns) {
            if (found >= 0) break;
            if (column.table == table && column.rising)
                found = static_cast<int>(column.column - table->columns.data());
        }
        if (found < 0) continue;
        const logs::LogColumn& column = table->columns[static_cast<std::size_t>(found)];
        times.insert(&column);
        if (!time.column.empty() || (by_name && !table->name.empty())) continue;
        time.column = column.name;
        if (!by_name)
            guesses.push_back({"time", Doubt::likely,
                               fmt::format("\"{}\" is the column that rises with every row", column.name)});
        settle_time_unit(time, column, guesses);
    }
    if (times.empty()) {
        time.sample_rate_Hz = 1000.0;
        guesses.push_back({"time", Doubt::doubtful,
                           "the log has no column of times; the rate is made up, state the logger's own"});
    }
    return times;
}

}  // namespace capstan::imports
