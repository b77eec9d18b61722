#pragma once

#include "capstan/storage/database.h"

namespace capstan::storage {

// Takes everything into the file itself and empties its log; an Error if that cannot be done. For a file that
// is about to get another name: a log stays under the old one, and what SQLite cannot write when a file is
// closed it keeps quiet about.
void fold_write_ahead_log(Database& database);

}  // namespace capstan::storage
