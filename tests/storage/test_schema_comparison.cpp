// Which differences of a schema count: what SQLite would do otherwise, and not how it is written down.

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <string>
#include <vector>

#include "capstan/storage/health.h"
#include "capstan/storage/schema.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

class SchemaComparison : public testing::Test {
  protected:
    // The problems after the stored text of a part of the schema became this expression of SQL.
    std::vector<std::string> problems_with(const std::string& part, const std::string& expression) {
        sqlite3_db_config(database.connection(), SQLITE_DBCONFIG_DEFENSIVE, 0, nullptr);
        database.execute("PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = " + expression +
                             " WHERE name = '" + part + "'",
                         "change the schema");
        EXPECT_EQ(sqlite3_changes(database.connection()), 1);
        return schema_problems(database);
    }
    using Problems = std::vector<std::string>;
    TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
};

TEST_F(SchemaComparison, PassesOverBlanksAndComments) {
    EXPECT_EQ(problems_with("v_progress",
                            "replace(sql, ' t.status', '  -- a remark' || char(10) || char(9) "
                            "|| ' t.status')"),
              Problems{});
    EXPECT_EQ(problems_with("v_progress", "replace(sql, '-- units', '-- numbers of units')"), Problems{});
}

TEST_F(SchemaComparison, NoticesAnotherFunctionOfAView) {
    EXPECT_EQ(problems_with("v_progress", "replace(sql, 'count(', 'total(')"),
              Problems{"the view v_progress was changed"});
}

TEST_F(SchemaComparison, NoticesAWordThatIsTwoInAView) {
    EXPECT_EQ(problems_with("v_progress", "replace(sql, 'units_done', 'units done')"),
              Problems{"the view v_progress was changed"});
}

TEST_F(SchemaComparison, NoticesWhatWasAddedAtTheEndOfAView) {
    EXPECT_EQ(problems_with("v_progress", "sql || ' LIMIT 1'"), Problems{"the view v_progress was changed"});
}

// A table is written down in another way after its migration; its columns have to be the same.
TEST_F(SchemaComparison, PassesOverTheOrderOfTheColumnsOfATable) {
    database.execute(
        "ALTER TABLE study_mark DROP COLUMN note; ALTER TABLE study_mark ADD COLUMN note TEXT NOT "
        "NULL DEFAULT ''",
        "move a column to the end");
    EXPECT_EQ(schema_problems(database), Problems{});
}

TEST_F(SchemaComparison, NoticesEveryPropertyOfAColumn) {
    for (const char* column : {"remark TEXT NOT NULL DEFAULT ''", "note BLOB NOT NULL DEFAULT ''",
                               "note TEXT DEFAULT ''", "note TEXT NOT NULL DEFAULT '-'"}) {
        Database file = Database::open_or_create(folder / "other.db");
        file.execute(
            std::string("ALTER TABLE study_mark DROP COLUMN note; ALTER TABLE study_mark ADD COLUMN ") +
                column,
            "replace a column");
        EXPECT_EQ(schema_problems(file), Problems{"the table study_mark was changed"}) << column;
        std::filesystem::remove(folder / "other.db");
    }
}

TEST_F(SchemaComparison, NoticesAnotherKey) {
    database.execute(
        "DROP TABLE study_mark; CREATE TABLE study_mark (study_id INTEGER REFERENCES study ON "
        "DELETE CASCADE, note TEXT NOT NULL DEFAULT '', tags TEXT NOT NULL DEFAULT '', is_deleted "
        "INTEGER NOT NULL DEFAULT 0 CHECK (is_deleted IN (0, 1))) STRICT",
        "leave the key out");
    EXPECT_EQ(schema_problems(database), Problems{"the table study_mark was changed"});
}

TEST_F(SchemaComparison, ARefusalSaysHowManyProblemsThereAre) {
    database.execute("DROP VIEW v_progress", "remove");
    const auto refusal = [&] { return error_of([&] { Database::open_existing(folder / "results.db"); }); };
    expect_says(refusal(), "the view v_progress is missing. `capstan doctor");
    database.execute("DROP VIEW v_recommendation", "remove");
    expect_says(refusal(), "the view v_progress is missing, and 1 more. `capstan doctor");
    database.execute("DROP VIEW v_best_method", "remove");
    expect_says(refusal(), ", and 2 more. `capstan doctor");
}

// Of a file that is not as capstan makes it nothing is counted.
TEST_F(SchemaComparison, AForeignSchemaIsNotExaminedFurther) {
    database.execute("DROP VIEW v_progress", "remove");
    const Health health = examine(database);
    EXPECT_EQ(health.problems, Problems{"the view v_progress is missing"});
    EXPECT_EQ(health.studies, 0);
    EXPECT_EQ(health.running_studies, 0);
    EXPECT_EQ(health.diagnoses, 0);
    EXPECT_EQ(health.cells, 0);
    EXPECT_EQ(health.hashed_parts, 0);
}

}  // namespace
}  // namespace capstan::storage
