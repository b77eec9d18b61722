#pragma once

#include "capstan/storage/database.h"

namespace capstan::storage {

// From now on every table and view of this connection is without the rows of studies in the trash, for
// whoever names it without a schema. For a database that was opened with open_read_only: only the connection
// changes.
void hide_trash(Database& database);

}  // namespace capstan::storage
