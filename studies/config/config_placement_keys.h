#pragma once

#include <vector>

#include "capstan/config/config_key.h"

namespace capstan::config {

/// The rows of [placement], for `capstan place`.
void add_placement_keys(std::vector<ConfigKey<StudyPlan>>& keys);

}  // namespace capstan::config
