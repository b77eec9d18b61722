#pragma once

#include <string>

#include "capstan/cli/command.h"
#include "capstan/placement/study_shard.h"
#include "capstan/storage/database.h"

namespace capstan::cli {

extern const Option shard_option;

/// "2/8". Throws UsageError for anything else.
Shard parse_shard(const std::string& text);

/// Whole studies do not go into a shard's file, nor are they resumed in it. Throws UsageError that says what
/// to do instead.
void refuse_shard_file(storage::Database& database);

}  // namespace capstan::cli
