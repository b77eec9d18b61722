#pragma once

#include <filesystem>
#include <functional>

#include "capstan/gap_trial/sealed_labels.h"

namespace capstan::gap_trial {

/// Told after each case: how many of how many are done.
using CaseProgress = std::function<void(const std::string& doing, int done, int of)>;

/// Simulates all cases of a trial on up to `jobs` threads (0: all processors) and files their recordings in
/// `folder`. The labels are not written: see `seal_labels`.
TrialLabels make_recordings(const TrialOptions& options, const std::filesystem::path& folder, int jobs,
                            const CaseProgress& on_progress);

}  // namespace capstan::gap_trial
