// The words about tables and columns, as they stand in the schema's comments.

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "capstan/storage/schema_documentation.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

DocumentedTable table(const std::string& name) {
    for (const DocumentedTable& each : schema_documentation())
        if (each.name == name) return each;
    throw std::out_of_range(name);
}

DocumentedColumn column(const std::string& table_name, const std::string& name) {
    for (const DocumentedColumn& each : table(table_name).columns)
        if (each.name == name) return each;
    throw std::out_of_range(name);
}

TEST(SchemaDocumentation, NamesEveryTableViewAndColumnOfAFile) {
    const TemporaryFolder folder;
    { Database created = Database::open_or_create(folder / "results.db"); }
    Database database = Database::open_read_only(folder / "results.db");
    const QueryResult names = run_read_only(
        database,
        "SELECT t.name, t.type = 'view', c.name, c.type, c.pk > 0 FROM sqlite_schema t, "
        "pragma_table_info(t.name) c WHERE t.type IN ('table', 'view') ORDER BY t.rowid, c.cid");
    std::vector<std::vector<QueryValue>> documented;
    for (const DocumentedTable& each : schema_documentation())
        for (const DocumentedColumn& one : each.columns)
            documented.push_back(
                {each.name, std::int64_t{each.is_view}, one.name, one.type, std::int64_t{one.is_key}});
    EXPECT_EQ(documented, names.rows);
}

TEST(SchemaDocumentation, HasWordsForEveryTableAndColumn) {
    for (const DocumentedTable& each : schema_documentation()) {
        EXPECT_FALSE(each.meaning.empty()) << each.name;
        for (const DocumentedColumn& one : each.columns)
            EXPECT_FALSE(one.meaning.empty()) << each.name << "." << one.name;
    }
}

TEST(SchemaDocumentation, TakesTheWordsBesideAndAboveALine) {
    EXPECT_EQ(table("study").meaning,
              "One question asked of the engine many times: a configuration, as it ran.");
    EXPECT_EQ(
        table("content_hash").meaning,
        "SHA-256 of what is stored of a study, written in the transaction that stores it: `capstan doctor` "
        "and a merge work it out again. Nothing but the stored values is in it: no number that depends on "
        "the file, on threads or on shards.");
    EXPECT_EQ(column("study", "seed").meaning, "64 bits, as SQLite keeps them: signed");
    EXPECT_EQ(column("regime", "regime").meaning, "Which part of the cable moves.");
    EXPECT_EQ(column("v_progress", "units_done").meaning, "stored work units");
}

TEST(SchemaDocumentation, AColumnWithoutWordsHasThoseOfTheFirstOfItsName) {
    EXPECT_EQ(column("v_progress", "status").meaning, column("study", "status").meaning);
    EXPECT_EQ(column("v_progress", "status").meaning, "running: begun, not ended; resume it");
}

TEST(SchemaDocumentation, ReadsTheUnitFromTheName) {
    EXPECT_EQ(column("cable_segment", "start_m").unit, "m");
    EXPECT_EQ(column("cable_segment", "wrap_angle_rad").unit, "rad");
    EXPECT_EQ(column("scenario", "time_s").unit, "s");
    EXPECT_EQ(column("cell", "mean_abs_error_N").unit, "N");
    EXPECT_EQ(column("diagnosis_number", "value_in_unit").unit, "unit");
    EXPECT_EQ(column("regime", "duty_fraction").unit, "");
}

TEST(SchemaDocumentation, SaysWhatMayBeMissing) {
    EXPECT_TRUE(column("cable_segment", "bend_radius_m").may_be_null);
    EXPECT_FALSE(column("cable_segment", "start_m").may_be_null);
    EXPECT_FALSE(column("study", "study_id").may_be_null);    // a key
    EXPECT_FALSE(column("v_progress", "units").may_be_null);  // of a view nobody says it
    EXPECT_FALSE(DocumentedColumn{}.is_key || DocumentedColumn{}.may_be_null || DocumentedTable{}.is_view);
}

TEST(SchemaDocumentation, IsATableOfMarkdownForEachTable) {
    const std::string markdown = schema_markdown();
    EXPECT_TRUE(markdown.starts_with(
        "\n#### study\n\nOne question asked of the engine many times: a configuration, as it ran.\n\n"
        "| column | type | unit | meaning |\n| --- | --- | --- | --- |\n"
        "| `study_id` | key, INTEGER |  | 1, 2, ... in the order they were begun |\n"
        "| `name` | TEXT |  | as in the configuration |\n"));
    expect_says(markdown, "| `bend_radius_m` | REAL or NULL | m | NULL: straight |\n");
    expect_says(markdown, "\n#### v_progress (view)\n\n" + table("v_progress").meaning + "\n\n| column |");
}

}  // namespace
}  // namespace capstan::storage
