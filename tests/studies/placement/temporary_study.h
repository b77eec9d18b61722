#pragma once
// A results file that lives as long as a test, and its complete content as one value.

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "capstan/placement/study_run.h"
#include "capstan/storage/read_only_query.h"

namespace capstan::test {

/// Every row of every table, in an order that does not depend on when it was written.
using Dump = std::map<std::string, std::vector<std::vector<storage::QueryValue>>>;

class TemporaryStudy {
  public:
    TemporaryStudy()
        : folder_(new_folder()), database_(storage::Database::open_or_create(folder_ / "results.db")) {}
    ~TemporaryStudy() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    TemporaryStudy(const TemporaryStudy&) = delete;
    TemporaryStudy& operator=(const TemporaryStudy&) = delete;

    storage::Database& database() { return database_; }

    std::vector<std::vector<storage::QueryValue>> rows(const std::string& select) {
        storage::Database reader = storage::Database::open_read_only(folder_ / "results.db");
        return storage::run_read_only(reader, select).rows;
    }

    Dump dump() {
        Dump tables;
        for (
            const auto& row : rows(
                "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT IN ('history', 'computed_with')")) {
            const std::string table = std::get<std::string>(row[0]);
            tables[table] = rows("SELECT * FROM " + table);
            std::sort(tables[table].begin(), tables[table].end());
        }
        return tables;
    }

  private:
    static std::filesystem::path new_folder() {
        std::string name = (std::filesystem::temp_directory_path() / "capstan-placement-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        return name;
    }

    std::filesystem::path folder_;
    storage::Database database_;
};

/// Table by table: a dump is too long to print.
inline void expect_same(const Dump& a, const Dump& b) {
    ASSERT_EQ(a.size(), b.size());
    for (const auto& [table, rows] : a) EXPECT_TRUE(rows == b.at(table)) << "table " << table << " differs";
}

}  // namespace capstan::test
