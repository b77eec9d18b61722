#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "capstan/storage/database.h"
#include "capstan/storage/records.h"

namespace capstan::paper {

/// The reason of a row that agrees.
inline const std::string agrees = "agrees";

/// Where the one sensor of Even and Both sits, which the paper does not say.
enum class OneSensor { both_ends, proximal_end, distal_end };

/// The numbers of the paper's Sec. III.C beside those of a stored study that repeats it (regimes mass and
/// partial_proximal, families even, distal, both with all counts, the paper's methods), at its first noise
/// level. Rows whose part is missing from the study are left out. Standard errors of averages are upper
/// bounds: cells share draws, and no cancellation is claimed.
///
/// A row agrees by storage::paper_agreement_words(); else its reason names the ablation of `paper estimation`
/// that shows it, or is called a guess.
std::vector<storage::PaperComparisonRecord> compare_placement(storage::Database& database,
                                                              std::int64_t study_id);
std::vector<storage::PaperComparisonRecord> compare_placement_with(OneSensor one_sensor,
                                                                   storage::Database& database,
                                                                   std::int64_t study_id);

}  // namespace capstan::paper
