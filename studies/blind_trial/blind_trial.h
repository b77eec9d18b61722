#pragma once

#include <functional>
#include <string>

#include "capstan/blind_trial/trial_folder.h"
#include "capstan/blind_trial/trial_score.h"

namespace capstan::gap_trial {

/// Called after each case with the activity and how many cases of how many are done.
using CaseProgress = std::function<void(const std::string& activity, int done, int of)>;

/// Simulates all cases of a trial on up to `jobs` threads (0: all processors) and writes their recordings to
/// `folder`. The labels are not written: see `seal_labels`.
TrialLabels make_recordings(const TrialOptions& options, const std::filesystem::path& folder, int jobs,
                            const CaseProgress& on_progress);

struct BlindTrialHooks {
    CaseProgress on_progress = [](const std::string&, int, int) {};
    /// Called with the labels' hash before the first diagnosis begins.
    std::function<void(const std::string& seal)> on_sealed = [](const std::string&) {};
};

/// Simulates the recordings unless the folder has them, and seals the labels. Returns their hash.
std::string prepare_trial(const TrialFolder& folder, const TrialOptions& options, int jobs,
                          const BlindTrialHooks& hooks);

/// Diagnoses every recording that has no answer yet, from its files alone, one case per thread.
void answer_trial(const TrialFolder& folder, const TrialOptions& options, const std::string& seal, int jobs,
                  const BlindTrialHooks& hooks);

/// Diagnoses one recording of a prepared trial, unless it has an answer, and returns the text of the answer.
/// Throws InvalidInput if the trial has no such case or is not sealed.
std::string answer_case(const TrialFolder& folder, int number);

/// Unseals the labels, fits the true causes where that is not done yet, and computes the score.
TrialScore unseal_and_score(const TrialFolder& folder, const std::string& seal, int jobs,
                            const BlindTrialHooks& hooks);

}  // namespace capstan::gap_trial
