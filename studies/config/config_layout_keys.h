#pragma once

#include <vector>

#include "capstan/config/config_key.h"

namespace capstan::config {

/// The rows of [layouts].
void add_layout_keys(std::vector<ConfigKey<StudyPlan>>& keys);
/// The rows of [estimation]: fusion methods and what they take for granted.
void add_estimation_keys(std::vector<ConfigKey<StudyPlan>>& keys);

}  // namespace capstan::config
