#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "capstan/placement/study_plan.h"

namespace capstan::cli {

/// Where keys stand in the text: "regime[2].samples" -> line, both from 1. Sections are in it too.
using KeyLines = std::map<std::string, int, std::less<>>;

struct ReadConfig {
    std::string file;  ///< as messages name it
    StudyPlan plan;    ///< with config_toml: the configuration in full, defaults included
    KeyLines lines;
};

/// Throws ConfigError with every problem that can be seen without simulating.
ReadConfig parse_config(std::string_view toml, const std::string& file);
ReadConfig read_config(const std::filesystem::path& path);

/// Throws ConfigError with the problems that the study finds in the plan, at the lines of the keys that they
/// name.
void require_runnable(const ReadConfig& config);

}  // namespace capstan::cli
