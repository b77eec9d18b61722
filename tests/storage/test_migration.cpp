// Migrating: an older file gets what later versions added and keeps what it holds.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

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
