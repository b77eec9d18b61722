#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "capstan/bench/bench_plan.h"
#include "capstan/config/config_problem.h"
#include "capstan/plan/study_plan.h"

namespace capstan::config {

/// A configuration read for its kind of plan.
template <class Plan>
struct ReadPlan {
    std::string file;  ///< as messages name it
    Plan plan;
    KeyLines lines;
};
using ReadConfig = ReadPlan<StudyPlan>;
using ReadBench = ReadPlan<bench::BenchPlan>;

/// Throws ConfigError with every problem that can be seen without simulating. Files that the text names are
/// read from `folder`; without one it may name none, so that a text from elsewhere reads nothing here.
template <class Plan>
ReadPlan<Plan> parse_plan(std::string_view toml, const std::string& file,
                          const std::optional<std::filesystem::path>& folder = {});
ReadConfig parse_config(std::string_view toml, const std::string& file);
/// The same of a file, with the log that it names for the far end. Refuses a bench with what it is good for.
ReadConfig read_config(const std::filesystem::path& path);
ReadBench read_bench(const std::filesystem::path& path);

}  // namespace capstan::config
