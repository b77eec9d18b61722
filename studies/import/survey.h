#pragma once

#include <vector>

#include "capstan/import/section.h"

namespace capstan::imports {

struct TimeGap {
    double from_s = 0.0;  ///< time of the last reading before the gap
    double to_s = 0.0;    ///< of the first one after it
};

/// What one pass over a channel's readings shows.
struct ChannelSurvey {
    std::size_t readings = 0;  ///< usable ones
    std::size_t missing = 0;   ///< rows without a number
    std::size_t repeated = 0;  ///< rows with the time of the row before; left out
    std::size_t backward = 0;  ///< rows with an earlier time; left out
    double first_s = 0.0;
    double last_s = 0.0;
    double period_s = 0.0;              ///< median distance of readings
    double jitter = 0.0;                ///< median deviation of the distances from it, as a fraction of it
    std::size_t bridged = 0;            ///< places where a few readings are missing, fewer than make a gap
    std::vector<TimeGap> gaps;          ///< longer ones
    double low = 0.0;                   ///< smallest reading, SI
    double high = 0.0;                  ///< largest
    double step = 0.0;                  ///< smallest distance of different readings, SI, if all distances are
                                        ///< multiples of it; 0: no lattice
    double typical_change = 0.0;        ///< 90% of the changes from reading to reading are smaller, SI
    std::size_t saturated = 0;          ///< readings in long rows of exactly the largest or smallest value
    double saturated_at_s = 0.0;        ///< the first of them
    std::vector<double> largest_jumps;  ///< the largest changes between neighbouring readings, none of which
                                        ///< is missing, SI, largest first; at most 64
    bool constant() const { return high == low; }
};

/// Missing readings that are bridged by straight lines; more are a gap. Friction remembers what happened in a
/// gap, so that a run has to be split there.
inline constexpr double longest_bridge_periods = 4.5;

ChannelSurvey survey_channel(const Source& source, RowRange rows);

/// The range of a counter that wraps round, in the column's unit: a turn of an angle, a power of two of
/// counts or `counts_per_turn`. 0: the readings show no wrap. The survey must be of the channel without
/// `wraps_at`.
double wrap_range(const ChannelSurvey& survey, const Source& source);

}  // namespace capstan::imports
