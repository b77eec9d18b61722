// What a file is, from its first bytes.

#include <gtest/gtest.h>
#include <sqlite3.h>

#include "capstan/storage/file_identity.h"
#include "capstan/storage/schema.h"
#include "capstan/storage/study_store.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

class Identity : public testing::Test {
  protected:
    // The file after plain SQLite ran this on it.
    FileIdentity after(const std::string& sql) {
        sqlite3* connection = nullptr;
        sqlite3_open(path.c_str(), &connection);
        EXPECT_EQ(sqlite3_exec(connection, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
        sqlite3_close(connection);
        return identify_file(path);
    }
    TemporaryFolder folder;
    const std::filesystem::path path = folder / "file.db";
};

TEST_F(Identity, OfADatabaseWithoutTablesIsThatItIsEmpty) {
    const FileIdentity identity = after("CREATE TABLE photo (name TEXT); DROP TABLE photo");
    EXPECT_EQ(identity.kind, FileKind::empty);
    EXPECT_EQ(identity.schema_version, 0);
    Database database = Database::open_or_create(path);
    EXPECT_TRUE(list_studies(database).empty());
}

TEST_F(Identity, OfADatabaseWithOneTableIsThatItIsForeign) {
    EXPECT_EQ(after("CREATE TABLE photo (name TEXT)").kind, FileKind::foreign_database);
}

// So many that the first page holds no row of the schema itself.
TEST_F(Identity, OfADatabaseWithManyTablesIsThatItIsForeign) {
    std::string sql = "BEGIN;";
    for (int k = 0; k < 300; ++k) sql += "CREATE TABLE photo" + std::to_string(k) + " (name TEXT);";
    EXPECT_EQ(after(sql + "COMMIT").kind, FileKind::foreign_database);
}

TEST_F(Identity, OfADatabaseWhoseTablesWaitInItsLogIsThatItIsForeign) {
    sqlite3* connection = nullptr;
    sqlite3_open(path.c_str(), &connection);
    sqlite3_exec(connection, "PRAGMA journal_mode = WAL; CREATE TABLE photo (name TEXT)", nullptr, nullptr,
                 nullptr);
    EXPECT_EQ(identify_file(path).kind, FileKind::foreign_database);
    sqlite3_close(connection);
}

TEST_F(Identity, HasTheVersionOfAFileOfOurs) {
    { Database database = Database::open_or_create(path); }
    const FileIdentity identity = identify_file(path);
    EXPECT_EQ(identity.kind, FileKind::capstan);
    EXPECT_EQ(identity.schema_version, schema_version);
}

// A file that bears the mark and never got its tables.
TEST_F(Identity, OfAMarkWithoutTablesIsNoStudy) {
    after("PRAGMA application_id = " + std::to_string(application_id));
    expect_says(error_of([&] { Database::open_existing(path); }), "holds no study yet");
}

}  // namespace
}  // namespace capstan::storage
