#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capstan/config/config_key.h"
#include "capstan/plan/true_cable.h"

namespace capstan::config {

/// [truth] and its effects, of a study or alone in a file of their own.
std::vector<ConfigSection<StudyPlan>> truth_sections();
std::vector<ConfigKey<StudyPlan>> truth_keys();

/// The [truth] of a file that holds nothing else, as `capstan diagnose --corrected` writes it. Throws
/// ConfigError.
TrueCable read_truth(const std::filesystem::path& path);

/// Such a file's text: what differs from the model, no more. `comments` stand at its top, a line each.
std::string truth_text(const TrueCable& truth, const std::vector<std::string>& comments);

}  // namespace capstan::config
