#pragma once

#include <string>

#include "capstan/storage/records.h"

namespace capstan {

/// What makes two stored studies different ones, for an error message ("its seed is 2, not 1"); empty for the
/// same study. Their numbers in the file and how far they have come do not count.
std::string difference_between(storage::StudyDescription one, storage::StudyDescription other);

}  // namespace capstan
