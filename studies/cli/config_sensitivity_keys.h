#pragma once

#include <vector>

#include "capstan/cli/config_key.h"

namespace capstan::cli {

/// The rows of [sensitivity], for `capstan sensitivity`.
void add_sensitivity_keys(std::vector<ConfigKey<StudyPlan>>& keys);

}  // namespace capstan::cli
