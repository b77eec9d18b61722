#pragma once

#include <string>

#include "capstan/gap_trial/trial_score.h"

namespace capstan::gap_trial {

/// The score as text: every fraction with its 95% interval.
std::string trial_table(const TrialScore& score);

/// The score as JSON.
std::string trial_json(const TrialOptions& options, const std::string& seal, const TrialScore& score);

}  // namespace capstan::gap_trial
