// How a file is opened, and that it is still where it was.

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
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

TEST(Connection, ItsLogIsFoldedOnlyWhereNobodyReadsWhatWasBefore) {
    const TemporaryFolder folder;
    Database writer = Database::open_or_create(folder / "results.db");
    sqlite3_busy_timeout(writer.connection(), 0);
    {
        Database reader = Database::open_read_only(folder / "results.db");
        reader.execute("BEGIN; SELECT count(*) FROM study", "read");
        writer.execute("CREATE TABLE further (number INTEGER)", "write");
        expect_says(error_of([&] { fold_write_ahead_log(writer); }), "another program reads it");
    }
    EXPECT_NO_THROW(fold_write_ahead_log(writer));
    EXPECT_EQ(std::filesystem::file_size((folder / "results.db").string() + "-wal"), 0u);
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
