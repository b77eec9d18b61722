// How a file is opened, and that it is still where it was.

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <iterator>
#include <optional>
#include <string>

#include "capstan/storage/database.h"
#include "capstan/storage/schema.h"
#include "capstan/storage/statement.h"
#include "capstan/storage/transaction.h"
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

// The file itself still says the version of before.
TEST(Connection, ForReadingRefusesANewerSchemaThatIsInTheLogOnly) {
    const TemporaryFolder folder;
    Database writer = Database::open_or_create(folder / "results.db");
    writer.execute("PRAGMA user_version = " + std::to_string(schema_version + 1), "migrate");
    expect_says(error_of([&] { Database::open_read_only(folder / "results.db"); }),
                "newer than version " + std::to_string(schema_version));
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

// Its log would stay under the name of before, so it is folded into the file first.
TEST(NewDatabase, IsOneFileWithItsContent) {
    const TemporaryFolder folder;
    write_new_database(folder / "new.db", [](Database& writer) {
        writer.execute("CREATE TABLE further (number INTEGER); INSERT INTO further VALUES (7)", "write");
        return true;
    });
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
    Database reader = Database::open_read_only(folder / "new.db");
    EXPECT_EQ(number_from(reader, "SELECT number FROM further"), 7);
    expect_says(error_of([&] { write_new_database(folder / "new.db", [](Database&) { return true; }); }),
                "exists already");
}

TEST(NewDatabase, ReplacesWhatAKilledProgramLeft) {
    const TemporaryFolder folder;
    std::ofstream(folder / "new.db.unfinished") << "part of a file";
    write_new_database(folder / "new.db", [](Database&) { return true; });
    EXPECT_FALSE(std::filesystem::exists(folder / "new.db.unfinished"));
    EXPECT_TRUE(Database::open_read_only(folder / "new.db").is_read_only());
}

TEST(NewDatabase, IsNotMadeWhileAnotherProgramReadsWhatWasBefore) {
    const TemporaryFolder folder;
    std::optional<Database> reader;
    const auto write = [&](Database& writer) {
        sqlite3_busy_timeout(writer.connection(), 0);
        reader.emplace(Database::open_read_only(writer.path()));
        reader->execute("BEGIN; SELECT count(*) FROM study", "read");
        writer.execute("CREATE TABLE further (number INTEGER)", "write");
        return true;
    };
    expect_says(error_of([&] { write_new_database(folder / "new.db", write); }), "another program reads it");
    EXPECT_FALSE(std::filesystem::exists(folder / "new.db"));
    EXPECT_FALSE(std::filesystem::exists(folder / "new.db.unfinished"));
}

TEST(NewDatabase, IsLeftOutWhereItsWriterSaysSo) {
    const TemporaryFolder folder;
    write_new_database(folder / "new.db", [](Database&) { return false; });
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Connection, SaysThatItsFileHasGoneWhileItWasWritten) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    Transaction transaction(database);
    database.execute("CREATE TABLE further (number INTEGER)", "write");
    std::filesystem::rename(folder / "results.db", folder / "elsewhere.db");
    expect_says(error_of([&] { transaction.commit(); }), "was removed or renamed");
}

TEST(Connection, ThatCannotBeMadeSaysWhereToLook) {
    const TemporaryFolder folder;
    expect_says(error_of([&] { Database::open_or_create(folder / "no such folder/results.db"); }),
                "check that its folder exists");
}

// Also SQLite's "cannot open" can mean a full disk: only where the system said so.
TEST(Connection, TellsAMissingFolderFromAFullDisk) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    const std::string attach = "ATTACH '" + (folder / "no such folder/other.db").string() + "' AS other";
    const std::string message = error_of([&] { database.execute(attach, "attach"); });
    expect_says(message, "Cannot attach in " + (folder / "results.db").string());
    expect_says(message, "the file cannot be opened");
}

TEST(Connection, SaysWhichStatementsItCannotRead) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    const std::string message = error_of([&] { Statement(database, "SELEKT 1"); });
    expect_says(message, "Cannot prepare a statement in " + (folder / "results.db").string());
    expect_says(message, "syntax error");
}

// A connection that stays open would keep the log: the last one to close takes it away.
TEST(Connection, IsClosedWithItsObject) {
    const TemporaryFolder folder;
    { Database database = Database::open_or_create(folder / "results.db"); }
    EXPECT_FALSE(std::filesystem::exists((folder / "results.db").string() + "-wal"));
}

}  // namespace
}  // namespace capstan::storage
