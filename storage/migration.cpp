#include "capstan/storage/migration.h"

#include "capstan/platform/files.h"
#include "capstan/storage/error.h"
#include "capstan/storage/file_identity.h"
#include "capstan/storage/statement.h"
#include "capstan/storage/transaction.h"

namespace capstan::storage {
namespace {

int version_of(Database& database) {
    Statement statement(database, "PRAGMA user_version");
    statement.step();
    return statement.get<int>(0);
}

// Written under another name first: a copy that carries the final name is complete and on the disk.
void leave_copy(Database& database, int version) {
    const std::string copy = database.path().string() + ".version" + std::to_string(version);
    const std::string unfinished = copy + ".unfinished";
    std::filesystem::remove(unfinished);
    Statement statement(database, "VACUUM INTO ?1");
    statement.bind(1, unfinished);
    statement.run("copy the file before its migration");
    rename_durably(unfinished, copy);
}

const Migration& step_from(std::span<const Migration> steps, int version, const Database& database) {
    for (const Migration& step : steps) {
        if (step.from_version == version) return step;
    }
    throw Error(database.path().string() + " has schema version " + std::to_string(version) +
                ", from which this program knows no way to its own. Use the capstan that wrote it.");
}

void require_intact_references(Database& database) {
    Statement statement(database, "PRAGMA foreign_key_check");
    if (statement.step()) {
        throw Error(database.path().string() + " was not migrated: a row of table " +
                    statement.get<std::string>(0) + " would refer to nothing. Please report this.");
    }
}

}  // namespace

std::span<const Migration> migrations() {
    return {};  // version 1 is the first; {1, "ALTER TABLE ..."} will lead to version 2
}

void migrate(Database& database, std::span<const Migration> steps, int target_version) {
    const int found = version_of(database);
    if (found > target_version) refuse_newer(database.path(), found);
    if (found == target_version) return;
    leave_copy(database, found);
    // A step may rebuild a table; dropping the old one must not cascade. The check follows before the commit.
    database.execute("PRAGMA foreign_keys = OFF", "prepare the migration");
    {
        Transaction transaction(database);
        for (int version = version_of(database); version < target_version; ++version) {
            database.execute(step_from(steps, version, database).sql, "migrate the tables");
        }
        database.execute("PRAGMA user_version = " + std::to_string(target_version), "migrate the tables");
        require_intact_references(database);
        transaction.commit();
    }
    database.execute("PRAGMA foreign_keys = ON", "end the migration");
}

}  // namespace capstan::storage
