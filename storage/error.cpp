#include "capstan/storage/error.h"

#include <sqlite3.h>

#include <cerrno>
#include <string>

namespace capstan::storage {
namespace {

// Beside SQLITE_FULL there are calls that meet the full disk as "cannot extend the shared memory" and the
// like.
bool disk_is_full(sqlite3* connection, int code) {
    if (code == SQLITE_FULL) return true;
    const int system_error = sqlite3_system_errno(connection);
    return (code == SQLITE_IOERR || code == SQLITE_CANTOPEN) &&
           (system_error == ENOSPC || system_error == EDQUOT);
}

std::string what_to_try(sqlite3* connection, int extended_code) {
    const int code = extended_code & 0xff;
    if (disk_is_full(connection, code)) {
        return "the disk is full. What was finished is kept: free some space, then `capstan study resume` "
               "continues.";
    }
    switch (code) {
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
            return "another program holds the file locked. Wait until it has finished, or stop it, and try "
                   "again.";
        case SQLITE_READONLY:
            return "the file or its folder may not be written. Change the permission, or use a copy in a "
                   "folder "
                   "of yours.";
        case SQLITE_CANTOPEN:
        case SQLITE_PERM:
            return "the file cannot be opened. Check that its folder exists and that you may write there.";
        case SQLITE_NOTADB:
        case SQLITE_CORRUPT:
            return "the file is damaged. Restore a copy, or remove it and run the study again.";
        case SQLITE_IOERR:
            return "the disk reports an error. Check the disk and try again.";
        case SQLITE_CONSTRAINT:
            if (extended_code == SQLITE_CONSTRAINT_NOTNULL) {
                return "a value is missing. A result that is not a number counts as missing.";
            }
            return "the values break a rule of the schema; nothing of them was stored.";
        default:
            return "nothing of this step was stored.";
    }
}

}  // namespace

void throw_sqlite_error(sqlite3* connection, std::string_view doing) {
    const int extended_code = sqlite3_extended_errcode(connection);
    const char* path = sqlite3_db_filename(connection, "main");
    throw Error("Cannot " + std::string(doing) + " in " + (path ? path : "?") + ": " +
                what_to_try(connection, extended_code) + " (SQLite: " + sqlite3_errmsg(connection) + ")");
}

}  // namespace capstan::storage
