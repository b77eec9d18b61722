// Migrating: an older file gets what later versions added and keeps what it holds.
#include <gtest/gtest.h>

#include "capstan/storage/diagnosis_store.h"
#include "capstan/storage/health.h"
#include "capstan/storage/migration.h"
#include "capstan/storage/schema.h"
#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

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

TEST(Migrating, AVersionWithoutAMigrationIsRefused) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    expect_says(error_of([&] { migrate(database, {}, schema_version + 1); }), "knows no way");
}

TEST(Migrating, ANewerFileIsRefused) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    expect_says(error_of([&] { migrate(database, {}, schema_version - 1); }),
                "has schema version " + std::to_string(schema_version) + ", newer than");
}

// A migration that was killed leaves part of a copy.
TEST(Migrating, AnUnfinishedCopyIsReplaced) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    const std::string copy = "results.db.version" + std::to_string(schema_version);
    std::ofstream(folder / (copy + ".unfinished")) << "part of a copy";
    migrate(database, std::vector<Migration>{{schema_version, "SELECT 1"}}, schema_version + 1);
    EXPECT_FALSE(std::filesystem::exists(folder / (copy + ".unfinished")));
    EXPECT_TRUE(Database::open_read_only(folder / copy).is_read_only());
}

// A step may make a table anew; what refers to it stays.
TEST(Migrating, AStepMayReplaceATableThatOthersReferTo) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    begin_study(database, example_study());
    const std::vector<Migration> steps{
        {schema_version,
         "CREATE TABLE other AS SELECT * FROM study; DELETE FROM study; INSERT INTO study SELECT "
         "* FROM other; DROP TABLE other"}};
    migrate(database, steps, schema_version + 1);
    EXPECT_EQ(number_from(database, "SELECT count(*) FROM work_unit"), 8);
}

TEST(Migrating, AStepThatTearsAReferenceIsTakenBack) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    begin_study(database, example_study());
    const std::vector<Migration> steps{{schema_version, "DELETE FROM noise_level"}};
    expect_says(error_of([&] { migrate(database, steps, schema_version + 1); }),
                "a row of table work_unit would refer to nothing");
    EXPECT_EQ(number_from(database, "SELECT count(*) FROM noise_level"), 2);
    EXPECT_EQ(number_from(database, "PRAGMA user_version"), schema_version);
}

TEST(Migrating, HappensAlsoWhereAFileWouldBeCreated) {
    const TemporaryFolder folder;
    {
        Database database = Database::open_or_create(folder / "results.db");
        database.execute("PRAGMA user_version = " + std::to_string(schema_version - 1), "go back");
    }
    Database database = Database::open_or_create(folder / "results.db");
    EXPECT_EQ(number_from(database, "PRAGMA user_version"), schema_version);
}

void drop_tables_of_version_six(Database& database) {
    database.execute("DROP TABLE content_hash; DROP TABLE diagnosis_hash; DROP TABLE computed_with",
                     "go back");
}

// A diagnosis of version 2 has no intervals, and keeps everything else.
TEST(Migrating, ADiagnosisOfVersionTwoOpensWithoutIntervalsAndPresence) {
    const TemporaryFolder folder;
    {
        Database database = Database::open_or_create(folder / "results.db");
        DiagnosisRecord diagnosis;
        diagnosis.runs = "[1]";
        diagnosis.friction_ratio = 1.1;
        diagnosis.friction_low_ratio = 1.0;
        diagnosis.causes = {{"creep", "", "cable_a", "", {}, {{"fraction", 0.1, "", 0.05, 0.2}}}};
        diagnosis.effects = {{"creep", 0.9, 0.95, ""}};
        write_diagnosis(database, diagnosis);
        for (const char* ratio : {"friction", "stiffness", "pretension"})
            for (const char* end : {"low", "high"})
                database.execute(
                    std::string("ALTER TABLE diagnosis DROP COLUMN ") + ratio + "_" + end + "_ratio",
                    "go back");
        database.execute("ALTER TABLE diagnosis_number DROP COLUMN low_in_unit", "go back");
        database.execute("ALTER TABLE diagnosis_number DROP COLUMN high_in_unit", "go back");
        database.execute("ALTER TABLE diagnosis_effect DROP COLUMN present_fraction", "go back");
        database.execute("ALTER TABLE diagnosis_effect DROP COLUMN varies", "go back");
        drop_tables_of_version_six(database);
        database.execute("DROP TABLE history; DROP TABLE study_mark", "go back");
        database.execute("PRAGMA user_version = 2", "go back");
    }
    Database database = Database::open_existing(folder / "results.db");
    const DiagnosisRecord old = load_diagnosis(database, 1);
    EXPECT_EQ(old.friction_ratio, 1.1);
    EXPECT_FALSE(old.friction_low_ratio);
    EXPECT_EQ(old.causes.at(0).numbers.at(0).value_in_unit, 0.1);
    EXPECT_FALSE(old.causes.at(0).numbers.at(0).low_in_unit);
    EXPECT_EQ(old.effects.at(0).probability_fraction, 0.9);
    EXPECT_FALSE(old.effects.at(0).present_fraction);
    EXPECT_TRUE(schema_problems(database).empty());
}

// A study of version 4 has no date, and its number is not given again.
TEST(Migrating, AStudyOfVersionFourGetsAHistoryFromThenOn) {
    const TemporaryFolder folder;
    {
        Database database = Database::open_or_create(folder / "results.db");
        begin_study(database, example_study());
        drop_tables_of_version_six(database);
        database.execute("DROP TABLE history; DROP TABLE study_mark; PRAGMA user_version = 4", "go back");
    }
    Database database = Database::open_existing(folder / "results.db");
    EXPECT_EQ(list_studies(database).at(0).begun_utc, "");
    delete_study(database, 1);
    EXPECT_EQ(begin_study(database, example_study()), 2);
    EXPECT_EQ(list_studies(database).at(0).begun_utc.size(), std::string("2026-01-31T12:00:00Z").size());
}

// Of its numbers nobody knows whether they are as they were written; a study begun after the migration is
// hashed.
TEST(Migrating, AStudyOfVersionFiveIsNotHashedAndNoProblem) {
    const TemporaryFolder folder;
    {
        Database database = Database::open_or_create(folder / "results.db");
        begin_study(database, example_study());
        write_unit(database, 1, 0);
        DiagnosisRecord diagnosis;
        diagnosis.runs = "[1]";
        write_diagnosis(database, diagnosis);
        drop_tables_of_version_six(database);
        database.execute("PRAGMA user_version = 5", "go back");
    }
    Database database = Database::open_existing(folder / "results.db");
    for (int unit = 1; unit < 8; ++unit) write_unit(database, 1, unit);
    finish_study(database, 1, example_recommendations(), example_paper_comparison());
    begin_study(database, example_study());
    const Health health = examine(database);
    EXPECT_EQ(health.problems, std::vector<std::string>{});
    EXPECT_EQ(health.unhashed,
              (std::vector<std::string>{"study 1 (" + example_study().study.name + ")", "diagnosis 1"}));
    EXPECT_EQ(health.hashed_parts, 1);  // the description of study 2
    EXPECT_EQ(number_from(database, "SELECT count(*) FROM content_hash WHERE study_id = 1"), 0);
}

TEST(Migrating, EveryOlderVersionHasAMigration) {
    ASSERT_EQ(migrations().size(), static_cast<std::size_t>(schema_version - 1));
    for (std::size_t i = 0; i < migrations().size(); ++i) {
        EXPECT_EQ(migrations()[i].from_version, static_cast<int>(i) + 1);
    }
}

}  // namespace
}  // namespace capstan::storage
