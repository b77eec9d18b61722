#pragma once

#include <string>

#include "temporary_folder.h"

namespace capstan::fuzz {

/// A small results database with one study, complete, as FOLDER/sample.db. Its bytes are the same in every
/// run.
std::filesystem::path make_sample_database(const TemporaryFolder& folder);

}  // namespace capstan::fuzz
