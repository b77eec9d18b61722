#pragma once

#include <cstdint>
#include <vector>

#include "capstan/storage/database.h"
#include "capstan/storage/records.h"

namespace capstan::paper {

/// The numbers of the paper's Sec. III.C beside those of a stored study that repeats it (regimes mass and
/// partial_proximal, families even, distal, both with all counts, the paper's methods), at its first noise
/// level. Rows whose part is missing from the study are left out. Standard errors of averages are upper
/// bounds: cells share draws, and no cancellation is claimed.
std::vector<storage::PaperComparisonRecord> compare_placement(storage::Database& database,
                                                              std::int64_t study_id);

}  // namespace capstan::paper
