// migrate_file FILE: brings a results file to a version that no release has, by two invented steps. A file
// that has that version already stays as it is. Prints why it fails, and then returns 3, as the program does.
#include <sqlite3.h>

#include <cstdio>
#include <exception>

#include "capstan/storage/migration.h"
#include "capstan/storage/schema.h"
#include "capstan/storage/statement.h"

namespace {

using capstan::storage::schema_version;

// Enough writes for a kill or a fault to fall in the middle of them.
const capstan::storage::Migration steps[] = {
    {schema_version, "ALTER TABLE study ADD COLUMN author TEXT NOT NULL DEFAULT 'nobody'"},
    {schema_version + 1,
     "ALTER TABLE cell_node ADD COLUMN doubled_N REAL; UPDATE cell_node SET doubled_N = 2 * mean_abs_error_N"}};
constexpr int target_version = schema_version + 2;

int version_of(const char* path) {
    sqlite3* connection = nullptr;
    sqlite3_stmt* statement = nullptr;
    int version = 0;
    if (sqlite3_open_v2(path, &connection, SQLITE_OPEN_READWRITE, nullptr) == SQLITE_OK &&
        sqlite3_prepare_v2(connection, "PRAGMA user_version", -1, &statement, nullptr) == SQLITE_OK &&
        sqlite3_step(statement) == SQLITE_ROW)
        version = sqlite3_column_int(statement, 0);
    sqlite3_finalize(statement);
    sqlite3_close(connection);
    return version;
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fputs("usage: migrate_file FILE\n", stderr);
        return 2;
    }
    try {
        if (version_of(arguments[1]) == target_version) return 0;
        auto database = capstan::storage::Database::open_existing(arguments[1]);
        capstan::storage::migrate(database, steps, target_version);
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 3;
    }
}
