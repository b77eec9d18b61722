// How a file is opened, and that it is still where it was.

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <optional>
#include <string>

#include "capstan/storage/database.h"
#include "capstan/storage/schema.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

// Two of its settings last as long as the connection: 1 is NORMAL, enough beside a write-ahead log.
TEST(Connection, ChecksThePagesItReadsAndSynchronisesWithItsLog) {
    const TemporaryFolder folder;
    Database created = Database::open_or_create(folder / "results.db");
    EXPECT_EQ(number_from(created, "PRAGMA cell_size_check"), 1);
    EXPECT_EQ(number_from(created, "PRAGMA synchronous"), 1);
    EXPECT_EQ(number_from(created, "SELECT journal_mode = 'wal' FROM pragma_journal_mode"), 1);
    Database existing = Database::open_existing(folder / "results.db");
    EXPECT_EQ(number_from(existing, "PRAGMA synchronous"), 1);
}

TEST(Connection, ForReadingTrustsNoFunctionOfTheFilesOwnSchema) {
    const TemporaryFolder folder;
    Database::open_or_create(folder / "results.db");
    Database reader = Database::open_read_only(folder / "results.db");
    EXPECT_TRUE(reader.is_read_only());
    EXPECT_EQ(number_from(reader, "PRAGMA trusted_schema"), 0);
}

TEST(Connection, ForReadingRefusesAnOlderSchema) {
    const TemporaryFolder folder;
    {
        Database database = Database::open_or_create(folder / "results.db");
        database.execute("PRAGMA user_version = " + std::to_string(schema_version - 1), "age");
    }
    expect_says(error_of([&] { Database::open_read_only(folder / "results.db"); }),
                "older schema version " + std::to_string(schema_version - 1));
}

TEST(Connection, NoticesThatItsFileHasGoneElsewhere) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    EXPECT_NO_THROW(database.require_in_place());
    std::filesystem::rename(folder / "results.db", folder / "elsewhere.db");
    expect_says(error_of([&] { database.require_in_place(); }), "was removed or renamed");
    std::filesystem::rename(folder / "elsewhere.db", folder / "results.db");
    EXPECT_NO_THROW(database.require_in_place());
}

// A log would stay under the old name of a file.
TEST(Connection, ANewFileGetsItsNameOnlyWhereNobodyReadsWhatWasBefore) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "results.db";
    std::optional<Database> reader;
    const auto write_beside_a_reader = [&](Database& database) {
        sqlite3_busy_timeout(database.connection(), 0);
        reader = Database::open_read_only(database.path());
        reader->execute("BEGIN; SELECT count(*) FROM study", "read");
        database.execute("CREATE TABLE further (number INTEGER)", "write");
        return true;
    };
    expect_says(error_of([&] { write_new_database(path, write_beside_a_reader); }),
                "another program reads it");
    reader.reset();
    EXPECT_TRUE(std::filesystem::is_empty(path.parent_path()));
    write_new_database(path, [](Database&) { return true; });
    EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(Connection, ThatCannotBeMadeSaysWhereToLook) {
    const TemporaryFolder folder;
    expect_says(error_of([&] { Database::open_or_create(folder / "no such folder/results.db"); }),
                "check that its folder exists");
}

// A connection that stays open would keep the log: the last one to close takes it away.
TEST(Connection, IsClosedWithItsObject) {
    const TemporaryFolder folder;
    { Database database = Database::open_or_create(folder / "results.db"); }
    EXPECT_FALSE(std::filesystem::exists((folder / "results.db").string() + "-wal"));
}

}  // namespace
}  // namespace capstan::storage
