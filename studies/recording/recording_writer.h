#pragma once

#include <filesystem>
#include <string>

#include "capstan/recording/recording.h"

namespace capstan {

/// The samples of a recording as NAME.csv has them: run, t and the channels, numbers to nine digits.
std::string samples_csv(const Recording& recording);

/// Its sidecar, with every key that the recording has a value for.
std::string sidecar_text(const Recording& recording);

/// Writes NAME.csv and NAME.json; `path` is either name. Throws std::runtime_error if a file cannot be
/// written.
void write_recording(const std::filesystem::path& path, const Recording& recording);

}  // namespace capstan
