#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "capstan/placement/study_run.h"
#include "capstan/storage/database.h"

namespace capstan {

/// A random part of a stored study, computed once more and compared bit by bit.
struct Recomputation {
    RunEnd end = RunEnd::complete;
    int units = 0;     ///< that are stored; of a study over worlds, pairs of a condition and a world
    int compared = 0;  ///< of them
    std::vector<std::string> problems;  ///< in words: which unit, which table
};

struct Sample {
    double fraction = 0.05;  ///< of the stored units, above 0; at least one unit is compared
    std::uint64_t seed = 1;  ///< of the choice
};

/// Nothing is written. Throws InvalidInput if this program rejects the stored configuration, storage::Error if
/// the study was computed with vector instructions of another width than those in use, since its last bits
/// would differ.
Recomputation recompute(storage::Database& database, std::int64_t study_id, const Sample& sample,
                        const RunOptions& options);

}  // namespace capstan
