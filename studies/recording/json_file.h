#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

namespace capstan {

/// Throws InvalidInput with file, line and column if the file cannot be read or is no JSON.
nlohmann::json read_json_file(const std::filesystem::path& path);

}  // namespace capstan
