#pragma once

#include <vector>

#include "capstan/cli/config_key.h"

namespace capstan::cli {

/// The rows of [placement], for `capstan place`.
void add_placement_keys(std::vector<ConfigKey<StudyPlan>>& keys);

}  // namespace capstan::cli
