// The schema keeps its own rules.
#include <gtest/gtest.h>

#include "temporary_results.h"

namespace capstan::storage {
namespace {

struct Column {
    std::string table;
    std::string name;
    std::string type;
};

std::vector<Column> columns_of_live_schema() {
    const TemporaryFolder folder;
    Database::open_or_create(folder / "results.db");
    Database database = Database::open_read_only(folder / "results.db");
    std::vector<Column> columns;
    for (const auto& row : run_read_only(database,
                                         "SELECT t.name, c.name, c.type FROM sqlite_schema t, "
                                         "pragma_table_info(t.name) c WHERE t.type = 'table'")
                               .rows) {
        columns.push_back(
            {std::get<std::string>(row[0]), std::get<std::string>(row[1]), std::get<std::string>(row[2])});
    }
    return columns;
}

bool ends_in_one_of(const std::string& name, const std::vector<std::string>& ends) {
    for (const std::string& end : ends) {
        if (name.ends_with(end)) return true;
    }
    return false;
}

TEST(Schema, EveryRealColumnEndsInAUnitOrSaysThatItHasNone) {
    const std::vector<Column> columns = columns_of_live_schema();
    ASSERT_GT(columns.size(), 100u);
    for (const Column& column : columns) {
        if (column.type != "REAL") continue;
        EXPECT_TRUE(ends_in_one_of(column.name, {"_N", "_m", "_rad", "_s", "_fraction", "_ratio", "_count",
                                                 "_log", "_in_unit", "_N2", "price"}))
            << column.table << "." << column.name;
    }
}

TEST(Schema, NoTableHasAColumnForAClock) {
    for (const Column& column : columns_of_live_schema()) {
        EXPECT_FALSE(ends_in_one_of(column.name, {"_at", "_date", "timestamp"}))
            << column.table << "." << column.name;
    }
}

TEST(Schema, EveryViewRunsOnADatabaseWithoutStudies) {
    const TemporaryFolder folder;
    Database::open_or_create(folder / "results.db");
    Database database = Database::open_read_only(folder / "results.db");
    const QueryResult views = run_read_only(database, "SELECT name FROM sqlite_schema WHERE type = 'view'");
    ASSERT_GE(views.rows.size(), 5u);
    for (const auto& view : views.rows) {
        const auto& name = std::get<std::string>(view[0]);
        EXPECT_TRUE(run_read_only(database, "SELECT * FROM " + name).rows.empty()) << name;
    }
}

TEST(Schema, ItsTextNamesTheVersionOfTheProgram) {
    EXPECT_NE(schema_text().find("of capstan, version " + std::to_string(schema_version) + "."),
              std::string::npos);
}

}  // namespace
}  // namespace capstan::storage
