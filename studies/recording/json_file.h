#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace capstan {

/// The bytes of a file that the user named. Throws InvalidInput if it cannot be read.
std::string read_input_file(const std::filesystem::path& path);

/// Throws InvalidInput with file, line and column if the file cannot be read or is not JSON.
nlohmann::json read_json_file(const std::filesystem::path& path);

}  // namespace capstan
