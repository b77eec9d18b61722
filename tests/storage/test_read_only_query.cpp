// The query box reads everything and changes nothing.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>
#include <map>

#include "capstan/storage/report_queries.h"
#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

class QueryBox : public testing::Test {
  protected:
    QueryBox() {
        Database writer = Database::open_or_create(folder / "results.db");
        begin_study(writer, example_study());
        write_unit(writer, 1, 0);
        write_unit(writer, 1, 1);
    }

    std::string refusal(const std::string& sql) {
        return error_of([&] { run_read_only(database(), sql); });
    }

    Database& database() {
        static_cast<void>(opened ? 0 : (opened.emplace(Database::open_read_only(folder / "results.db")), 0));
        return *opened;
    }

    TemporaryFolder folder;
    std::optional<Database> opened;
};

TEST_F(QueryBox, GivesColumnsAndTypedValues) {
    const QueryResult result =
        run_read_only(database(), "SELECT study_id AS id, name, 0.5, NULL FROM study WHERE name = ?1",
                      {std::string("example")});
    EXPECT_EQ(result.columns, (std::vector<std::string>{"id", "name", "0.5", "NULL"}));
    ASSERT_EQ(result.rows.size(), 1u);
    EXPECT_EQ(result.rows[0],
              (std::vector<QueryValue>{std::int64_t{1}, std::string("example"), 0.5, std::monostate{}}));
}

TEST_F(QueryBox, ReadsEveryViewWithJoinsWindowsAndRecursion) {
    EXPECT_FALSE(run_read_only(database(), "SELECT * FROM v_error_by_layout").rows.empty());
    EXPECT_FALSE(run_read_only(database(), "SELECT * FROM v_best_method").rows.empty());
    EXPECT_FALSE(run_read_only(database(), "SELECT * FROM v_single_sensor_matrix").rows.empty());
    EXPECT_EQ(run_read_only(database(), "SELECT * FROM v_progress").rows.size(), 1u);
    EXPECT_EQ(run_read_only(database(),
                            "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 9) "
                            "SELECT i FROM n;  -- counted\n ;")
                  .rows.size(),
              9u);
    EXPECT_EQ(run_read_only(database(), "SELECT value FROM sensor_set, json_each(nodes)").rows.size(), 6u);
}

TEST_F(QueryBox, RefusesEveryStatementThatWrites) {
    const std::string before = bytes_of(folder / "results.db");
    const std::string other = (folder / "other.db").string();
    for (const std::string& sql : {
             std::string("DELETE FROM study"),
             std::string("INSERT INTO study DEFAULT VALUES"),
             std::string("UPDATE study SET name = 'x'"),
             std::string("UPDATE sqlite_master SET sql = 'x'"),
             std::string("DROP TABLE study"),
             std::string("CREATE TABLE x (y)"),
             std::string("CREATE TEMP TABLE x (y)"),
             std::string("CREATE TEMP VIEW x AS SELECT 1"),
             "ATTACH '" + other + "' AS other",
             std::string("DETACH main"),
             "VACUUM INTO '" + other + "'",
             std::string("VACUUM"),
             std::string("REINDEX"),
             std::string("ANALYZE"),
             std::string("BEGIN"),
             std::string("SAVEPOINT x"),
             std::string("COMMIT"),
             std::string("PRAGMA user_version = 9"),
             std::string("PRAGMA journal_mode = DELETE"),
             std::string("PRAGMA writable_schema = 1"),
             std::string("PRAGMA query_only = 0"),
             std::string("PRAGMA temp_store_directory = '/'"),
             std::string("SELECT * FROM pragma_journal_mode"),
             std::string("SELECT load_extension('x')"),
             std::string("SELECT fts3_tokenizer('simple')"),
             std::string("CREATE VIRTUAL TABLE x USING fts5(y)"),
             std::string("EXPLAIN DELETE FROM study"),
             std::string("WITH x AS (SELECT 1) DELETE FROM study"),
         }) {
        expect_says(refusal(sql), "may only read");
    }
    EXPECT_FALSE(std::filesystem::exists(other));
    EXPECT_EQ(bytes_of(folder / "results.db"), before);
    EXPECT_EQ(list_studies(database()).at(0).name, "example");
}

TEST_F(QueryBox, RunsExactlyOneStatement) {
    expect_says(refusal("SELECT 1; SELECT 2"), "more than one statement");
    expect_says(refusal("SELECT 1; DROP TABLE study"), "more than one statement");
    expect_says(refusal("SELECT 1; nonsense"), "more than one statement");
    expect_says(refusal(" -- nothing\n"), "empty");
    expect_says(refusal(""), "empty");
}

TEST_F(QueryBox, ExplainsAMistakeAndPointsToTheSchema) {
    expect_says(refusal("SELECT * FROM studies"), "no such table: studies");
    expect_says(refusal("SELECT * FROM studies"), "capstan query --schema");
    expect_says(refusal("SELECT tension FROM cell"), "no such column: tension");
    expect_says(refusal("SELECT tension FROM cell"), "capstan query --schema");
    expect_says(refusal("SELEKT 1"), "syntax error");
    expect_says(refusal("SELECT ?1"), "1 parameters, but 0 values");
}

TEST_F(QueryBox, StopsAQueryThatTakesTooLong) {
    const std::string endless =
        "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT max(i) FROM n";
    expect_says(error_of([&] { run_read_only(database(), endless, {}, {.time_limit_s = 0.05}); }),
                "longer than 0.05 s");
    EXPECT_EQ(run_read_only(database(), "SELECT 1").rows.size(), 1u);  // and is ready for the next
}

TEST_F(QueryBox, CutsOffRowsBeyondTheLimitAndSaysSo) {
    const QueryResult all = run_read_only(database(), "SELECT * FROM sensor_set", {}, {.row_limit = 3});
    EXPECT_EQ(all.rows.size(), 3u);
    EXPECT_FALSE(all.truncated);
    const QueryResult cut = run_read_only(database(), "SELECT * FROM sensor_set", {}, {.row_limit = 2});
    EXPECT_EQ(cut.rows.size(), 2u);
    EXPECT_TRUE(cut.truncated);
}

TEST_F(QueryBox, CutsOffFewRowsThatTakeTooMuchMemoryAndSaysSo) {
    const QueryResult result =
        run_read_only(database(),
                      "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 900) "
                      "SELECT zeroblob(900000) FROM n",
                      {}, {.row_limit = 1000});
    EXPECT_TRUE(result.truncated);
    EXPECT_LT(result.rows.size() * 900'000, 70'000'000u);
}

// A single step of SQLite's machine, which no clock interrupts, must not take long either.
TEST_F(QueryBox, RefusesValuesSoLongThatOneStepWouldOutlastTheTimeLimit) {
    expect_says(refusal("SELECT zeroblob(1000001)"), "too big");
    expect_says(refusal("SELECT instr(hex(zeroblob(20000000)), hex(zeroblob(10000000)) || 'b')"), "too big");
    EXPECT_EQ(run_read_only(database(), "SELECT length(zeroblob(1000000))").rows.size(), 1u);
}

TEST_F(QueryBox, RefusesADatabaseThatWasOpenedForWriting) {
    Database writer = Database::open_existing(folder / "results.db");
    expect_says(error_of([&] { run_read_only(writer, "SELECT 1"); }), "opened for reading");
}

TEST_F(QueryBox, ShowsTheSchemaAsTheFileHasIt) {
    const auto names =
        run_read_only(database(), "SELECT name FROM sqlite_schema WHERE type IN ('table', 'view')").rows;
    for (const auto& row : names) {
        EXPECT_NE(schema_text().find(std::get<std::string>(row[0]) + " "), std::string::npos);
    }
}

// A statement of a few lines can be compiled for minutes, and a pattern be compared for hours.
TEST_F(QueryBox, RefusesLongStatementsAndPatterns) {
    expect_says(refusal("SELECT 1" + std::string(100'000, ' ')), "too long");
    EXPECT_EQ(refusal("SELECT 1" + std::string(90'000, ' ')), "");
    expect_says(refusal("SELECT 'x' LIKE hex(zeroblob(300))"), "pattern too complex");
    EXPECT_EQ(refusal("SELECT 'x' LIKE hex(zeroblob(240))"), "");
}

TEST_F(QueryBox, SaysTheTimeLimitInShortNumbers) {
    const std::string endless =
        "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT max(i) FROM n";
    expect_says(error_of([&] { run_read_only(database(), endless, {}, {.time_limit_s = 0.25}); }),
                "longer than 0.25 s and");
    expect_says(error_of([&] { run_read_only(database(), endless, {}, {.time_limit_s = 0}); }),
                "longer than 0 s and");
}

// The limit of bytes counts the values' own texts: a few long ones are cut off, many short ones are not.
TEST_F(QueryBox, CountsTheBytesOfTexts) {
    const auto rows_of = [&](const std::string& value, int rows) {
        return run_read_only(database(),
                             "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < " +
                                 std::to_string(rows) + ") SELECT " + value + " FROM n",
                             {}, {.row_limit = 100'000});
    };
    const QueryResult longs = rows_of("zeroblob(900000)", 100);
    EXPECT_TRUE(longs.truncated);
    EXPECT_EQ(longs.rows.size(), 10u);  // the tenth passes 8 MiB
    const QueryResult shorts = rows_of("i", 20'000);
    EXPECT_FALSE(shorts.truncated);
    EXPECT_EQ(shorts.rows.size(), 20'000u);
}

TEST_F(QueryBox, TakesParametersOfEveryKind) {
    const std::vector<QueryValue> values{std::int64_t{1} << 40, 0.5, std::string("text"), std::monostate{}};
    EXPECT_EQ(run_read_only(database(), "SELECT ?1, ?2, ?3, ?4", values).rows.at(0), values);
}

TEST_F(QueryBox, ReadsNoFurtherThanItsText) {
    const std::string two = "SELECT 1; SELECT 2";
    EXPECT_EQ(run_read_only(database(), std::string_view(two).substr(0, 8)).rows.size(), 1u);
    expect_says(refusal("SELECT 1; ; SELECT 2"), "more than one statement");
}

TEST_F(QueryBox, AnAnswerWithoutRowsIsComplete) {
    EXPECT_FALSE(run_read_only(database(), "SELECT 1 WHERE 0").truncated);
    EXPECT_FALSE(QueryResult{}.truncated);
}

// The next reader of the connection is bound neither by the rules for guests nor by the time of one.
TEST_F(QueryBox, LeavesTheConnectionFree) {
    const std::string count =
        "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < 100000) SELECT count(*) FROM n";
    EXPECT_NE(error_of([&] { run_read_only(database(), count, {}, {.time_limit_s = 0}); }), "");
    EXPECT_EQ(number_from(database(), count), 100'000);
    EXPECT_EQ(number_from(database(), "PRAGMA user_version"), schema_version);
}

TEST_F(QueryBox, GivesEveryRowByItself) {
    std::vector<std::size_t> sizes;
    visit_read_only(database(), "SELECT 1, 2 UNION ALL SELECT 3, 4",
                    {[](const std::vector<std::string>&) {},
                     [&](std::vector<QueryValue>& row) {
                         sizes.push_back(row.size());
                         return true;
                     }});
    EXPECT_EQ(sizes, (std::vector<std::size_t>{2, 2}));
}

TEST_F(QueryBox, RefusesAQueryThatNeedsMoreMemoryThanItMayHave) {
    const std::string large = "SELECT hex(zeroblob(450000))";
    EXPECT_EQ(refusal(large), "");
    limit_query_memory(sqlite3_memory_used() + 300'000);
    const std::string message = refusal(large);
    limit_query_memory(0);
    expect_says(message, "needs more memory than a query may have");
    EXPECT_EQ(refusal(large), "");
}

TEST(PaperAgreement, SaysWhenANumberAgrees) {
    expect_says(paper_agreement_words(),
                "within 0.03 N (the paper's rounding and single draws) plus 2 of our");
    expect_says(paper_agreement_words(), "at most 2 standard errors above it.");
}

// Whatever names a study or belongs to one; what is in the trash is found by no query, until it is restored.
TEST_F(QueryBox, SeesNothingOfAStudyInTheTrash) {
    const auto rows = [](Database& from, const std::string& table) {
        return run_read_only(from, "SELECT count(*) FROM " + table).rows[0][0];
    };
    std::vector<std::string> names;
    for (const auto& row :
         run_read_only(database(),
                       "SELECT name FROM sqlite_schema WHERE type IN ('table', 'view') AND name NOT LIKE "
                       "'diagnosis%' AND name <> 'v_diagnosis'")
             .rows)
        names.push_back(std::get<std::string>(row[0]));
    EXPECT_GT(names.size(), 30u);
    std::map<std::string, QueryValue> before;
    for (const std::string& name : names) before[name] = rows(database(), name);
    EXPECT_EQ(before["study"], QueryValue(std::int64_t{1}));
    {
        Database writer = Database::open_or_create(folder / "results.db");
        trash_study(writer, 1);
    }
    {
        Database reader = Database::open_read_only(folder / "results.db");
        for (const std::string& name : names)
            if (name != "shard") {
                EXPECT_EQ(rows(reader, name), QueryValue(std::int64_t{0})) << name;
            }
    }
    Database writer = Database::open_or_create(folder / "results.db");
    restore_study(writer, 1);
    Database reader = Database::open_read_only(folder / "results.db");
    for (const std::string& name : names)
        if (name != "history" && name != "study_mark") {
            EXPECT_EQ(rows(reader, name), before[name]) << name;
        }
}

}  // namespace
}  // namespace capstan::storage
