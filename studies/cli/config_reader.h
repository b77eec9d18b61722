#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "capstan/bench/bench_plan.h"
#include "capstan/placement/study_plan.h"

namespace capstan::cli {

/// Where keys stand in the text: "regime[2].samples" -> line, both from 1. Sections are in it too.
using KeyLines = std::map<std::string, int, std::less<>>;

/// A configuration read for its kind of plan.
template <class Plan>
struct ReadPlan {
    std::string file;  ///< as messages name it
    Plan plan;         ///< with config_toml: the configuration in full, defaults included
    KeyLines lines;
};
using ReadConfig = ReadPlan<StudyPlan>;
using ReadBench = ReadPlan<bench::BenchPlan>;

enum class ConfigContent { study, bench };
/// What a file describes: a bench says so at its top. Throws ConfigError if it cannot be read; what is not
/// TOML passes for a study, whose reader says where.
ConfigContent content_of_config(const std::filesystem::path& path);

/// Throws ConfigError with every problem that can be seen without simulating.
template <class Plan>
ReadPlan<Plan> parse_plan(std::string_view toml, const std::string& file);
ReadConfig parse_config(std::string_view toml, const std::string& file);
/// Refuses a bench with what it is good for.
ReadConfig read_config(const std::filesystem::path& path);
ReadBench read_bench(const std::filesystem::path& path);

/// Throws ConfigError with the problems that the study finds in the plan, at the lines of the keys that they
/// name.
void require_runnable(const ReadConfig& config);

}  // namespace capstan::cli
