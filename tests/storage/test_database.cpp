// Opening: ours is welcome, anything else keeps every byte.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <set>

#include "capstan/storage/schema.h"
#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

using Opener = Database (*)(const std::filesystem::path&);
const std::vector<Opener> all_openers{
    [](const std::filesystem::path& path) { return Database::open_or_create(path); }, Database::open_existing,
    [](const std::filesystem::path& path) { return Database::open_read_only(path); }};

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

void run_plain_sqlite(const std::filesystem::path& path, const std::string& sql) {
    sqlite3* connection = nullptr;
    sqlite3_open(path.c_str(), &connection);
    EXPECT_EQ(sqlite3_exec(connection, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
    sqlite3_close(connection);
}

std::set<std::string> names_in(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.insert(entry.path().filename());
    return names;
}

void expect_refused_untouched(const TemporaryFolder& folder, const std::string& name,
                              const std::string& says) {
    const std::string before = bytes_of(folder / name);
    const auto names_before = names_in(folder.path());
    for (const Opener open : all_openers) {
        const std::string message = error_of([&] { open(folder / name); });
        expect_says(message, says);
        expect_says(message, (folder / name).string());
        EXPECT_EQ(bytes_of(folder / name), before);
        EXPECT_EQ(names_in(folder.path()), names_before);
    }
}

TEST(OpeningADatabase, ANewFileIsMarkedAndKeepsItsStudies) {
    const TemporaryFolder folder;
    {
        Database database = Database::open_or_create(folder / "results.db");
        EXPECT_EQ(number_from(database, "PRAGMA application_id"), application_id);
        EXPECT_EQ(number_from(database, "PRAGMA user_version"), schema_version);
        EXPECT_EQ(number_from(database, "PRAGMA foreign_keys"), 1);
        EXPECT_EQ(number_from(database, "SELECT journal_mode = 'wal' FROM pragma_journal_mode"), 1);
        begin_study(database, example_study());
    }
    for (const Opener open : all_openers) {
        Database database = open(folder / "results.db");
        EXPECT_EQ(list_studies(database).size(), 1u);
    }
    EXPECT_EQ(bytes_of(folder / "results.db").substr(68, 4), "CPST");
}

TEST(OpeningADatabase, AMissingFileIsOnlyCreatedWhenAsked) {
    const TemporaryFolder folder;
    for (const Opener open : {all_openers[1], all_openers[2]}) {
        const std::string message = error_of([&] { open(folder / "none.db"); });
        expect_says(message, "does not exist");
        expect_says(message, "capstan study run");
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "none.db"));
    expect_says(error_of([&] { Database::open_or_create(folder / "no/such/folder.db"); }), "folder exists");
}

TEST(OpeningADatabase, AFileThatIsNotADatabaseIsRefusedUntouched) {
    const TemporaryFolder folder;
    write_bytes(folder / "letter.txt", "Dear reader,\n" + std::string(5000, 'x'));
    expect_refused_untouched(folder, "letter.txt", "is not a database");
    write_bytes(folder / "short", "x");
    expect_refused_untouched(folder, "short", "is not a database");
}

TEST(OpeningADatabase, AForeignDatabaseIsRefusedUntouched) {
    const TemporaryFolder folder;
    run_plain_sqlite(folder / "photos.db", "CREATE TABLE photo (name TEXT)");
    expect_refused_untouched(folder, "photos.db", "not one of capstan's");
    run_plain_sqlite(folder / "marked.db", "PRAGMA application_id = 7");
    expect_refused_untouched(folder, "marked.db", "not one of capstan's");
}

TEST(OpeningADatabase, AForeignDatabaseWithAnUnfinishedLogIsRefusedUntouched) {
    const TemporaryFolder folder;
    sqlite3* connection = nullptr;
    sqlite3_open((folder / "busy.db").c_str(), &connection);
    sqlite3_exec(connection, "PRAGMA journal_mode = WAL; CREATE TABLE photo (name TEXT)", nullptr, nullptr,
                 nullptr);
    expect_refused_untouched(folder, "busy.db", "not one of capstan's");
    sqlite3_close(connection);
}

TEST(OpeningADatabase, ANewerSchemaIsRefusedUntouchedAndBothVersionsAreNamed) {
    const TemporaryFolder folder;
    Database::open_or_create(folder / "results.db");
    run_plain_sqlite(folder / "results.db", "PRAGMA user_version = 42");
    expect_refused_untouched(folder, "results.db",
                             "version 42, newer than version " + std::to_string(schema_version));
}

TEST(OpeningADatabase, AFolderIsRefused) {
    const TemporaryFolder folder;
    for (const Opener open : all_openers) expect_says(error_of([&] { open(folder.path()); }), "folder");
}

TEST(OpeningADatabase, TheNextOpeningRepairsAKilledCreation) {
    const TemporaryFolder folder;
    write_bytes(folder / "results.db", "");
    expect_says(error_of([&] { Database::open_existing(folder / "results.db"); }), "holds no study yet");
    expect_says(error_of([&] { Database::open_read_only(folder / "results.db"); }), "holds no study yet");
    Database database = Database::open_or_create(folder / "results.db");
    EXPECT_EQ(begin_study(database, example_study()), 1);
}

// Runs the call in a process of its own that dies without closing anything.
void run_and_die(const std::function<void()>& call) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        call();
        kill(getpid(), SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
}

TEST(KilledProcess, DuringCreationIsRepairedByTheNext) {
    const TemporaryFolder folder;
    run_and_die([&] {
        sqlite3* connection = nullptr;
        sqlite3_open((folder / "results.db").c_str(), &connection);
        // A cache of one page: some of the schema is in the file before the commit.
        const std::string begun = "PRAGMA cache_size = 1; BEGIN IMMEDIATE;" + schema_text() +
                                  "; PRAGMA application_id = " + std::to_string(application_id);
        sqlite3_exec(connection, begun.c_str(), nullptr, nullptr, nullptr);
    });
    Database database = Database::open_or_create(folder / "results.db");
    EXPECT_EQ(begin_study(database, example_study()), 1);
}

TEST(KilledProcess, DuringAUnitKeepsTheEarlierUnits) {
    const TemporaryFolder folder;
    run_and_die([&] {
        Database database = Database::open_or_create(folder / "results.db");
        begin_study(database, example_study());
        write_unit(database, 1, 0);
        database.execute("BEGIN IMMEDIATE; UPDATE work_unit SET done = 1; DELETE FROM single_sensor", "test");
    });
    {
        Database reader = Database::open_read_only(folder / "results.db");
        EXPECT_EQ(pending_units(reader, 1).size(), 7u);
    }
    Database database = Database::open_existing(folder / "results.db");
    EXPECT_EQ(read_single_sensor(database, 1, 0, 0), example_single_sensor(0, 0).sensors);
    write_unit(database, 1, 1);
    EXPECT_EQ(pending_units(database, 1).size(), 6u);
}

TEST(OpeningADatabase, SeveralProcessesMayCreateItAtOnce) {
    const TemporaryFolder folder;
    std::vector<pid_t> children;
    for (int i = 0; i < 4; ++i) {
        children.push_back(fork());
        if (children.back() == 0) {
            const std::string message = error_of([&] {
                Database database = Database::open_or_create(folder / "results.db");
                begin_study(database, example_study());
            });
            if (!message.empty()) fprintf(stderr, "%s\n", message.c_str());
            _exit(message.empty() ? 0 : 1);
        }
    }
    for (const pid_t child : children) {
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(status, 0);
    }
    Database database = Database::open_existing(folder / "results.db");
    EXPECT_EQ(list_studies(database).size(), 4u);
}

TEST(OpeningADatabase, AcceptsFileNamesWithSpecialCharacters) {
    const TemporaryFolder folder;
    const auto path = folder / "50% of what? #1 it's.db";
    {
        Database database = Database::open_or_create(path);
        begin_study(database, example_study());
    }
    Database database = Database::open_read_only(path);
    EXPECT_EQ(list_studies(database).size(), 1u);
}

TEST(OpeningADatabase, AReaderSeesTheStateBeforeAnOpenTransaction) {
    const TemporaryFolder folder;
    Database writer = Database::open_or_create(folder / "results.db");
    begin_study(writer, example_study());
    writer.execute("BEGIN IMMEDIATE; UPDATE study SET name = 'renamed'", "test");
    Database reader = Database::open_read_only(folder / "results.db");
    EXPECT_EQ(list_studies(reader).at(0).name, "example");
    writer.execute("COMMIT", "test");
    EXPECT_EQ(list_studies(reader).at(0).name, "renamed");
}

TEST(OpeningADatabase, ASecondWriterGetsAnErrorWhenItWaitedTooLong) {
    const TemporaryFolder folder;
    Database first = Database::open_or_create(folder / "results.db");
    Database second = Database::open_existing(folder / "results.db");
    sqlite3_busy_timeout(second.connection(), 20);
    first.execute("BEGIN IMMEDIATE", "test");
    expect_says(error_of([&] { begin_study(second, example_study()); }), "locked");
    first.execute("ROLLBACK", "test");
    EXPECT_EQ(begin_study(second, example_study()), 1);
}

}  // namespace
}  // namespace capstan::storage
