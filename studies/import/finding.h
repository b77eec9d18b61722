#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace capstan::imports {

/// What an import can find in a log.
enum class FindingKind {
    repeated_samples,
    unordered_times,
    missing_readings,
    gap,
    short_stretch,
    jitter,
    clock_offset,
    wrapped_counter,
    saturated,
    constant_channel,
    swapped_channels,
    wrong_unit,
    wrong_sign,
    time_unit,
    unread,   ///< part of a file that could not be read
    assumed,  ///< something that the mapping does not state
};

/// "gap", "wrong unit".
std::string finding_name(FindingKind kind);

/// One thing that an import found, and what was done about it.
struct Finding {
    FindingKind kind = FindingKind::gap;
    bool repaired = false;  ///< the recording differs from the log because of it; else a doubt
    int log_run = 0;        ///< which run of the log, from 1; 0: all
    std::string channel{};  ///< empty: all
    std::size_t count = 0;  ///< samples or places
    double amount = 0.0;    ///< of a clock offset: s; of a unit: the factor; of a wrapped counter: its range
    double uncertainty = 0.0;  ///< of `amount`, where it is estimated
    std::string words;         ///< a sentence: what it is, where, what was done or what to do
};

}  // namespace capstan::imports
