#pragma once

#include <filesystem>

#include "capstan/recording/recording.h"

namespace capstan {

/// Reads a recording: a CSV of samples and a JSON sidecar of the same name beside it; either name is taken.
/// Throws InvalidInput with everything that is wrong: file, line or key, what it is and what to try. Besides
/// broken lines and keys that is: a time that does not increase or has a gap, a run without samples, a driven
/// channel that is constant in every run, a channel in other units than it says.
Recording read_recording(const std::filesystem::path& path);

}  // namespace capstan
