#pragma once

#include <vector>

#include "capstan/config/config_key.h"

namespace capstan::config {

/// The rows of [sensitivity], for `capstan sensitivity`.
void add_sensitivity_keys(std::vector<ConfigKey<StudyPlan>>& keys);

}  // namespace capstan::config
