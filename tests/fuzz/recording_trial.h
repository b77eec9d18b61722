#pragma once

#include <filesystem>

namespace capstan::fuzz {

/// Reads a recording, and where it is taken, moves its twin through the first run. Refusals are fine.
void try_recording(const std::filesystem::path& samples);

}  // namespace capstan::fuzz
