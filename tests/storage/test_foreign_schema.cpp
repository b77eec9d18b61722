// Files whose schema others have changed: refused in words before anything of it is run.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "capstan/storage/health.h"
#include "capstan/storage/migration.h"
#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

constexpr const char* endless =
    "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) SELECT count(*) AS study_id FROM n";

// The file after somebody ran this on it, as every way of opening it sees it.
void expect_refused(const std::string& sql, const std::string& words) {
    const TemporaryFolder folder;
    const auto path = folder / "results.db";
    {
        Database database = Database::open_or_create(path);
        begin_study(database, example_study());
        database.execute("PRAGMA foreign_keys = OFF; PRAGMA legacy_alter_table = ON", "change");
        database.execute(sql, "change");
    }
    expect_says(error_of([&] { Database::open_read_only(path); }), words);
    expect_says(error_of([&] { Database::open_existing(path); }), words);
    expect_says(error_of([&] { Database::open_or_create(path); }), words);
    Database database = Database::open_read_only(path, SchemaCheck::none);
    const Health health = examine(database);
    ASSERT_FALSE(health.problems.empty());
    EXPECT_NE(health.problems.front().find(words), std::string::npos) << health.problems.front();
}

TEST(ForeignSchema, AViewThatWasReplacedIsNotRun) {
    expect_refused(std::string("DROP VIEW v_progress; CREATE VIEW v_progress AS ") + endless,
                   "the view v_progress was changed");
}

TEST(ForeignSchema, ATableThatBecameAViewIsNotRead) {
    expect_refused(std::string("ALTER TABLE study RENAME TO old; CREATE VIEW study AS ") + endless,
                   "the table study was changed");
}

TEST(ForeignSchema, AMissingTableIsNamed) {
    expect_refused("DROP TABLE cell_block", "the table cell_block is missing");
    expect_refused("DROP INDEX cell_of_set", "the index cell_of_set is missing");
}

TEST(ForeignSchema, ATriggerIsRefused) {
    expect_refused("CREATE TRIGGER t AFTER UPDATE ON study BEGIN DELETE FROM work_unit; END",
                   "the trigger t");
}

TEST(ForeignSchema, AGeneratedColumnIsRefused) {
    expect_refused("ALTER TABLE study ADD COLUMN x INTEGER AS (length(name))", "the table study was changed");
}

TEST(ForeignSchema, FurtherTablesAndViewsDoNoHarm) {
    const TemporaryFolder folder;
    {
        Database database = Database::open_or_create(folder / "results.db");
        database.execute(
            std::string("CREATE TABLE mine (x); CREATE INDEX fast ON mine (x); CREATE VIEW v AS ") + endless,
            "add");
    }
    Database database = Database::open_existing(folder / "results.db");
    EXPECT_TRUE(schema_problems(database).empty());
}

TEST(ForeignSchema, AFileThatIsAPipeIsNotWaitedFor) {
    const TemporaryFolder folder;
    const auto path = folder / "pipe.db";
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    expect_says(error_of([&] { Database::open_or_create(path); }), "a pipe");
    expect_says(error_of([&] { Database::open_read_only(path); }), "a pipe");
}

}  // namespace
}  // namespace capstan::storage
