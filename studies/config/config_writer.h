#pragma once

#include <string>
#include <string_view>

#include "capstan/bench/bench_plan.h"
#include "capstan/plan/study_plan.h"

namespace capstan::config {

enum class Comments { none, every_key };

/// The configuration of a plan in full: every section and key in the order of the key table, so that equal
/// plans have equal texts, and reading the text gives the plan again.
template <class Plan>
std::string config_text(const Plan& plan, Comments comments);

/// The shortest text that reads back as the same number and marks it as a real number.
std::string toml_number(double value);

/// The text in quotes, with what cannot stand in them escaped.
std::string toml_string(std::string_view text);

/// The plan of an empty configuration: all defaults.
StudyPlan default_plan();
bench::BenchPlan default_bench();

}  // namespace capstan::config
