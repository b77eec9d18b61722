#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace capstan::config {

/// The bytes of a configuration file. Throws ConfigError if it cannot be read.
std::string content_of(const std::filesystem::path& path);

enum class ConfigContent { study, bench };
/// What a configuration describes: a bench says so at its top, or has pulleys. What is not TOML passes for a
/// study, whose reader says where.
ConfigContent content_described_by(std::string_view toml);
/// The same of a file. Throws ConfigError if it cannot be read.
ConfigContent content_of_config(const std::filesystem::path& path);

}  // namespace capstan::config
