#pragma once

#include <vector>

#include "capstan/config/config_key.h"

namespace capstan::config {

/// The rows of [sweep], for many studies from one file.
void add_sweep_keys(std::vector<ConfigKey<StudyPlan>>& keys);

}  // namespace capstan::config
