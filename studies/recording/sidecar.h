#pragma once

#include <filesystem>

#include "capstan/recording/problem_list.h"
#include "capstan/recording/recording.h"

namespace capstan {

/// Reads what the JSON sidecar says of a recording: everything but the samples. What is missing or wrong goes
/// into `problems` with the key it belongs to. Throws InvalidInput if the file cannot be read or is no JSON.
Recording read_sidecar(const std::filesystem::path& path, ProblemList& problems);

}  // namespace capstan
