#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "capstan/bench_model/bench_model.h"

namespace capstan::bench_model {

/// A model as TOML with comments; every number in the fewest digits that read back as the same bits.
std::string model_text(const BenchModel& model);
/// Throws ConfigError (an InvalidInput) with every problem as FILE:LINE: key: what is wrong; what to try.
BenchModel parse_model(std::string_view toml, const std::string& file);

/// Whether a text says that it is a model, correct or not.
bool is_model(std::string_view toml);

/// Whether a file can be a model, by its name's ending.
bool names_a_model(const std::filesystem::path& path);
BenchModel read_model(const std::filesystem::path& path);
/// Throws InvalidInput where write_model() would destroy a file that is not a model, or where the name does
/// not end in .toml.
void require_model_name(const std::filesystem::path& path);
/// Completely or not at all. Throws as require_model_name().
void write_model(const std::filesystem::path& path, const BenchModel& model);

}  // namespace capstan::bench_model
