#include "capstan/storage/write_ahead_log.h"

#include "capstan/storage/error.h"
#include "capstan/storage/statement.h"

namespace capstan::storage {

void fold_write_ahead_log(Database& database) {
    constexpr const char* doing = "take the log into the file";
    Statement statement(database, "PRAGMA wal_checkpoint(TRUNCATE)");
    statement.step(doing);
    if (statement.get<int>(0) != 0)
        throw Error(std::string("Cannot ") + doing + ": another program reads it.");
}

}  // namespace capstan::storage
