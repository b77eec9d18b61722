// Opening: ours is welcome, anything else keeps every byte.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "capstan/storage/migration.h"
#include "capstan/storage/schema.h"
#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

using Opener = Database (*)(const std::filesystem::path&);
const std::vector<Opener> all_openers{
    [](const std::filesystem::path& path) { return Database::open_or_create(path); }, Database::open_existing,
    Database::open_read_only};

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

TEST(OpeningADatabase, AFileThatIsNoDatabaseIsRefusedUntouched) {
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
    expect_refused_untouched(folder, "results.db", "version 42, newer than version 4");
}

TEST(OpeningADatabase, AFolderIsRefused) {
    const TemporaryFolder folder;
    for (const Opener open : all_openers) expect_says(error_of([&] { open(folder.path()); }), "folder");
}

TEST(OpeningADatabase, AKilledCreationIsHealedByTheNext) {
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

TEST(AKilledProcess, InTheMiddleOfCreationIsHealedByTheNext) {
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

TEST(AKilledProcess, InTheMiddleOfAUnitLeavesTheUnitsBefore) {
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

TEST(OpeningADatabase, AnOddNameIsOnlyAName) {
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

TEST(OpeningADatabase, ASecondWriterThatWaitedInVainIsToldSo) {
    const TemporaryFolder folder;
    Database first = Database::open_or_create(folder / "results.db");
    Database second = Database::open_existing(folder / "results.db");
    sqlite3_busy_timeout(second.connection(), 20);
    first.execute("BEGIN IMMEDIATE", "test");
    expect_says(error_of([&] { begin_study(second, example_study()); }), "locked");
    first.execute("ROLLBACK", "test");
    EXPECT_EQ(begin_study(second, example_study()), 1);
}

TEST(Migrating, AnOlderFileGetsEveryStepAndLeavesACopy) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    begin_study(database, example_study());
    const std::vector<Migration> steps{
        {schema_version, "ALTER TABLE study ADD COLUMN author TEXT NOT NULL DEFAULT 'nobody'"},
        {schema_version + 1, "UPDATE study SET author = 'somebody'"}};
    migrate(database, steps, schema_version + 2);
    EXPECT_EQ(number_from(database, "PRAGMA user_version"), schema_version + 2);
    EXPECT_EQ(number_from(database, "PRAGMA foreign_keys"), 1);
    EXPECT_EQ(number_from(database, "SELECT count(*) FROM study WHERE author = 'somebody'"), 1);

    Database copy =
        Database::open_read_only(folder / ("results.db.version" + std::to_string(schema_version)));
    EXPECT_EQ(list_studies(copy).size(), 1u);
}

TEST(Migrating, AStepThatFailsLeavesTheFileAsItWas) {
    const TemporaryFolder folder;
    const std::vector<Migration> steps{{schema_version, "DROP VIEW v_progress"},
                                       {schema_version + 1, "DROP TABLE no_such_table"}};
    {
        Database database = Database::open_or_create(folder / "results.db");
        EXPECT_THROW(migrate(database, steps, schema_version + 2), Error);
    }
    Database database = Database::open_existing(folder / "results.db");
    EXPECT_TRUE(list_studies(database).empty());
}

TEST(Migrating, AVersionWithoutAWayIsRefused) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    expect_says(error_of([&] { migrate(database, {}, schema_version + 1); }), "knows no way");
}

// What version 4 added.
const std::string back_to_version_3 = bytes_of(CAPSTAN_TESTS_STORAGE "/back_to_version_3.sql");

// What version 3 added.
const std::string back_to_version_2 = back_to_version_3 + R"sql(
DROP VIEW v_diagnosis; DROP TABLE diagnosis_gap; DROP TABLE diagnosis_channel; DROP TABLE diagnosis_candidate;
DROP TABLE diagnosis_number; DROP TABLE diagnosis_cause; DROP TABLE diagnosis_effect; DROP TABLE diagnosis;
ALTER TABLE noise_level DROP COLUMN quantisation_N; ALTER TABLE noise_level DROP COLUMN range_N;
PRAGMA user_version = 2;)sql";

// Each table's columns and each view, as queries see them.
std::vector<std::vector<QueryValue>> shape_of(const std::filesystem::path& path) {
    Database database = Database::open_read_only(path);
    return run_read_only(database,
                         "SELECT t.type, t.name, c.cid, c.name, c.type, c.\"notnull\", c.pk "
                         "FROM sqlite_schema t, pragma_table_info(t.name) c ORDER BY t.name, c.cid")
        .rows;
}

TEST(Migrating, AFileOfVersion2IsOpenedWithItsStudiesAndLooksLikeANewOne) {
    const TemporaryFolder folder;
    StudyDescription description = example_study();
    {
        Database database = Database::open_or_create(folder / "results.db");
        description.study.study_id = begin_study(database, description);
        write_unit(database, 1, 0);
        database.execute(back_to_version_2, "make an older file");
    }
    Database database = Database::open_existing(folder / "results.db");
    // What the sensors' step and range were stands in the configuration alone.
    for (NoiseLevelRecord& level : description.noise_levels)
        level.quantisation_N = level.range_N = std::nullopt;
    EXPECT_EQ(load_study(database, 1), description);
    EXPECT_EQ(list_studies(database).at(0).units_done, 1);
    Database::open_or_create(folder / "new.db");
    EXPECT_EQ(shape_of(folder / "results.db"), shape_of(folder / "new.db"));
    EXPECT_TRUE(std::filesystem::exists(folder / "results.db.version2"));
}

// What the views that read kept rows say, of studies that are complete and that are not.
std::vector<std::vector<QueryValue>> averages_of(const std::filesystem::path& path) {
    Database database = Database::open_read_only(path);
    std::vector<std::vector<QueryValue>> rows;
    for (const char* sql : {"SELECT * FROM v_error_by_layout ORDER BY 1, 3, 4, 6, 7, 8",
                            "SELECT * FROM v_best_method ORDER BY 1, 3, 4, 6, 7",
                            "SELECT * FROM v_single_sensor_matrix ORDER BY 1, 3, 4, 6, 7, 8"}) {
        std::ranges::move(run_read_only(database, sql).rows, std::back_inserter(rows));
    }
    return rows;
}

TEST(Migrating, AFileOfVersion3KeepsWhatItsViewsSay) {
    const TemporaryFolder folder;
    {
        Database database = Database::open_or_create(folder / "results.db");
        const auto complete = begin_study(database, example_study());
        for (const int unit : pending_units(database, complete)) write_unit(database, complete, unit);
        finish_study(database, complete, example_recommendations(), example_paper_comparison());
        const auto running = begin_study(database, example_study());
        write_unit(database, running, 0);
        write_unit(database, running, 1);
    }
    const auto before = averages_of(folder / "results.db");
    {
        Database database = Database::open_existing(folder / "results.db");
        EXPECT_GT(number_from(database, "SELECT count(*) FROM layout_error"), 0);
        database.execute(back_to_version_3, "make an older file");
        EXPECT_EQ(
            number_from(
                database,
                "SELECT (SELECT count(*) FROM v_error_by_layout) + (SELECT count(*) FROM v_best_method) "
                "+ (SELECT count(*) FROM v_single_sensor_matrix)"),
            static_cast<int>(before.size()));
    }
    {
        Database database = Database::open_existing(folder / "results.db");
        EXPECT_EQ(number_from(database, "PRAGMA user_version"), schema_version);
        EXPECT_EQ(number_from(database, "SELECT count(DISTINCT study_id) FROM layout_error"), 1);
        EXPECT_EQ(number_from(database, "SELECT count(DISTINCT study_id) FROM sensor_matrix"), 1);
    }
    EXPECT_EQ(averages_of(folder / "results.db"), before);
    Database::open_or_create(folder / "new.db");
    EXPECT_EQ(shape_of(folder / "results.db"), shape_of(folder / "new.db"));
}

// What version 2 added is taken away again.
TEST(Migrating, AFileOfVersion1IsOpenedWithItsStudies) {
    const TemporaryFolder folder;
    {
        Database database = Database::open_or_create(folder / "results.db");
        begin_study(database, example_study());
        write_unit(database, 1, 0);
        database.execute(back_to_version_2 + "DROP TABLE shard; PRAGMA user_version = 1",
                         "make an older file");
    }
    Database database = Database::open_existing(folder / "results.db");
    EXPECT_EQ(number_from(database, "PRAGMA user_version"), schema_version);
    EXPECT_EQ(list_studies(database).at(0).units_done, 1);
    EXPECT_FALSE(read_shard(database));
    EXPECT_TRUE(std::filesystem::exists(folder / "results.db.version1"));
}

TEST(Migrating, EveryOlderVersionHasAWay) {
    ASSERT_EQ(migrations().size(), static_cast<std::size_t>(schema_version - 1));
    for (std::size_t i = 0; i < migrations().size(); ++i) {
        EXPECT_EQ(migrations()[i].from_version, static_cast<int>(i) + 1);
    }
}

}  // namespace
}  // namespace capstan::storage
