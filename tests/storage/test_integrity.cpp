// Content hashes: whatever bit of a stored number changes, the check finds it and names the table.
#include <gtest/gtest.h>

#include <bit>
#include <iostream>
#include <map>
#include <random>

#include "capstan/storage/diagnosis_store.h"
#include "capstan/storage/health.h"
#include "capstan/storage/integrity/computed_with.h"
#include "capstan/storage/integrity/content_hash.h"
#include "capstan/storage/integrity/verification.h"
#include "capstan/storage/statement.h"
#include "capstan/storage/world_store.h"
#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

// These are about the studies and the machines, and no part of a study.
const std::string not_hashed_tables = "('history', 'study_mark', 'shard', 'computed_with')";

std::int64_t write_complete_study(Database& database) {
    const std::int64_t study_id = begin_study(database, example_study());
    for (const int unit : pending_units(database, study_id)) write_unit(database, study_id, unit);
    finish_study(database, study_id, example_recommendations(), example_paper_comparison());
    return study_id;
}

StudyDescription world_description() {
    StudyDescription study;
    study.study = {0, "worlds", "[uncertainty]", "0.1.0", 7, 40, 10, "running"};
    study.world_candidates = {{"[]", "no sensor", "", 0, 0.0}, {"[{}]", "tension at 0.6 m", "even", 1, 2.5}};
    return study;
}

std::vector<WorldErrorRecord> world_errors(int first, int last) {
    std::vector<WorldErrorRecord> errors;
    for (int world = first; world < last; ++world)
        for (const int candidate : {0, 1})
            errors.push_back({candidate, world % 2 == 0 ? "as_stated" : "half_width", world,
                              0.1 * world + 1.03, 0.2 * world + 1.07, 0.3 * world + 1.09, 0.4 * world + 1.11,
                              0.95});
    return errors;
}

std::int64_t write_world_study(Database& database) {
    const std::int64_t study_id = begin_study(database, world_description());
    write_world_errors(database, study_id, world_errors(50, 80));
    write_world_errors(database, study_id, world_errors(0, 50));
    add_world_candidate(database, study_id, 2, {"[{},{}]", "two", "", 2, 5.5});
    finish_world_study(database, study_id,
                       {"all_nodes", 1, "ensemble_filter", 0.1, 0.2, 0.09, 0.11, 0.3, 1, "Use it."});
    return study_id;
}

void write_small_diagnosis(Database& database) {
    DiagnosisRecord diagnosis;
    diagnosis.recording = "bench";
    diagnosis.runs = "[1]";
    diagnosis.friction_ratio = 1.1;
    diagnosis.stiffness_low_ratio = 0.8;
    diagnosis.effects = {{"creep", 0.9, 0.95, ""}, {"none", 0.1, {}, ""}};
    diagnosis.causes = {{"creep", "", "cable_a", "", 0.4, {{"fraction", 0.1, "", 0.05, 0.2}}}};
    write_diagnosis(database, diagnosis);
}

void fill_with_one_of_each(Database& database) {
    write_complete_study(database);
    write_complete_study(database);
    write_world_study(database);
    write_small_diagnosis(database);
}

std::vector<std::string> texts_from(Database& database, const std::string& sql) {
    Statement select(database, sql);
    std::vector<std::string> texts;
    while (select.step()) texts.push_back(select.get<std::string>(0));
    return texts;
}

std::vector<std::string> hashed_tables(Database& database) {
    return texts_from(database, "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT IN " +
                                    not_hashed_tables + " ORDER BY name");
}

// One number of the file: a column of a row.
struct NumberCell {
    std::string table;
    std::string column;
    bool is_real = false;
    std::string where;  // the row, by its primary key
};

NumberCell random_cell(Database& database, const std::vector<std::string>& tables, std::mt19937_64& random) {
    for (;;) {
        NumberCell cell;
        cell.table = tables[random() % tables.size()];
        const auto rows = number_from(database, "SELECT count(*) FROM " + cell.table);
        const auto columns = texts_from(database, "SELECT name FROM pragma_table_info('" + cell.table +
                                                      "') WHERE type IN ('INTEGER', 'REAL') ORDER BY name");
        if (rows == 0 || columns.empty()) continue;
        cell.column = columns[random() % columns.size()];
        cell.is_real = number_from(database, "SELECT type = 'REAL' FROM pragma_table_info('" + cell.table +
                                                 "') WHERE name = '" + cell.column + "'") == 1;
        std::string key;
        for (const std::string& name :
             texts_from(database, "SELECT name FROM pragma_table_info('" + cell.table + "') WHERE pk > 0"))
            key += (key.empty() ? "'" : " || ' AND ") + name + " = ' || quote(" + name + ")";
        cell.where = texts_from(database, "SELECT " + key + " FROM " + cell.table + " LIMIT 1 OFFSET " +
                                              std::to_string(random() % static_cast<std::uint64_t>(rows)))
                         .at(0);
        return cell;
    }
}

// False: that bit cannot be flipped, because the value would not be one, or another row has it.
bool flip(Database& database, const NumberCell& cell, int bit) {
    const std::string from = " FROM " + cell.table + " WHERE " + cell.where;
    Statement select(database, "SELECT " + cell.column + ", " + cell.column + " IS NULL" + from);
    EXPECT_TRUE(select.step()) << from;
    if (select.get<int>(1) == 1) return false;
    Statement update(database, "UPDATE " + cell.table + " SET " + cell.column + " = ?1 WHERE " + cell.where +
                                   " AND " + cell.column + " IS NOT ?1");
    if (cell.is_real)
        update.bind(1, std::bit_cast<double>(std::bit_cast<std::uint64_t>(select.get<double>(0)) ^
                                             (std::uint64_t{1} << bit)));
    else
        update.bind(1, select.get<std::int64_t>(0) ^ static_cast<std::int64_t>(std::uint64_t{1} << bit));
    select.reset();
    try {
        update.run("flip a bit");
    } catch (const Error&) {
        return false;
    }
    return sqlite3_changes(database.connection()) == 1;
}

TEST(ContentHash, EveryFlippedBitOfAStoredNumberIsFound) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    fill_with_one_of_each(database);
    ASSERT_EQ(examine(database).problems, std::vector<std::string>{});
    database.execute("PRAGMA foreign_keys = OFF; PRAGMA ignore_check_constraints = ON", "allow anything");
    const std::vector<std::string> tables = hashed_tables(database);
    std::mt19937_64 random(24);
    std::map<std::string, int> flips;
    int found = 0;
    for (int tried = 0; tried < 2000;) {
        const NumberCell cell = random_cell(database, tables, random);
        database.execute("BEGIN", "begin");
        const int bit = static_cast<int>(random() % 64);
        if (flip(database, cell, bit)) {
            ++tried;
            ++flips[cell.table];
            const bool is_found = !examine(database).problems.empty();
            found += is_found ? 1 : 0;
            EXPECT_TRUE(is_found) << cell.table << "." << cell.column << " where " << cell.where << ", bit "
                                  << bit;
        }
        database.execute("ROLLBACK", "end");
    }
    std::cout << found << " of 2000 flipped bits found, in " << flips.size() << " tables\n";
    EXPECT_GT(flips.size(), 25u);
}

// The same in the bytes of the file, where a bit can also be one of an index, of a text, or of nothing at
// all.
TEST(ContentHash, AFlippedBitOfTheFileIsFoundOrChangesNoNumber) {
    const TemporaryFolder folder;
    {
        Database database = Database::open_or_create(folder / "results.db", Journal::rollback);
        fill_with_one_of_each(database);
    }
    const auto content = [&](Database& database) {
        std::map<std::string, std::vector<std::string>> rows;
        for (const std::string& table : hashed_tables(database)) {
            const std::string columns =
                texts_from(
                    database,
                    "SELECT group_concat('quote(' || name || ')', '||'',''||') FROM pragma_table_info('" +
                        table + "')")
                    .at(0);
            rows[table] = texts_from(database, "SELECT " + columns + " FROM " + table + " ORDER BY 1");
        }
        return rows;
    };
    const std::string bytes = bytes_of(folder / "results.db");
    const auto expected = [&] {
        Database database = Database::open_read_only(folder / "results.db");
        return content(database);
    }();
    std::mt19937_64 random(25);
    int found = 0;
    int harmless = 0;
    for (int tried = 0; tried < 600; ++tried) {
        std::string damaged = bytes;
        const std::size_t at = random() % damaged.size();
        const int bit = static_cast<int>(random() % 8);
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
        std::ofstream(folder / "damaged.db", std::ios::binary)
            .write(damaged.data(), static_cast<std::streamsize>(damaged.size()));
        try {
            Database database = Database::open_read_only(folder / "damaged.db", SchemaCheck::none);
            if (examine(database).problems.empty()) {
                ++harmless;
                EXPECT_EQ(content(database), expected) << "byte " << at << ", bit " << bit;
                continue;
            }
        } catch (const Error&) {
        }
        ++found;
    }
    std::cout << found << " of 600 flipped bits of the file found, " << harmless << " changed nothing\n";
    EXPECT_GT(found, 100);
}

TEST(ContentHash, TheCheckNamesUnitAndTable) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    write_complete_study(database);
    database.execute(
        "UPDATE cell_block SET mean_abs_error_N = mean_abs_error_N * 1.000000000001 WHERE cell_id = "
        "(SELECT max(cell_id) FROM cell) AND block = 2",
        "damage the file");
    const HashCheck check = check_hashes(database);
    ASSERT_EQ(check.problems.size(), 1u);
    expect_says(check.problems[0], "study 1 (example), unit 7 (stage fusion, instant 1, noise ");
    expect_says(check.problems[0], ": table cell_block is not as it was written");
}

TEST(ContentHash, ALostOrAnAddedRowIsNamed) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    write_world_study(database);
    database.execute("DELETE FROM world_error WHERE world = 70 AND candidate_index = 1", "damage the file");
    expect_says(
        check_hashes(database).problems.at(0),
        "study 1 (worlds), worlds as_stated, numbers 64 to 127: table world_error is not as it was written");
    write_world_errors(database, 1, {});
    database.execute("DELETE FROM world_error", "damage the file");
    EXPECT_EQ(check_hashes(database).problems.size(), 4u);  // two conditions, two blocks of worlds
}

TEST(ContentHash, DoesNotDependOnTheFileOrTheOrderOfTheUnits) {
    const TemporaryFolder folder;
    Database one = Database::open_or_create(folder / "one.db");
    Database other = Database::open_or_create(folder / "other.db");
    write_complete_study(one);
    write_world_study(other);
    const std::int64_t second = begin_study(other, example_study());
    for (const int unit : {7, 2, 4, 0, 1, 6, 5, 3}) write_unit(other, second, unit);
    finish_study(other, second, example_recommendations(), example_paper_comparison());
    EXPECT_EQ(study_hash(one, 1).size(), 64u);
    EXPECT_EQ(study_hash(one, 1), study_hash(other, second));
}

// Rows that come in another order than they are stored in are hashed as they are stored.
TEST(ContentHash, DoesNotDependOnTheOrderOfAResult) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    begin_study(database, example_study());
    FusionResult result = example_fusion(0, 0);
    std::reverse(result.cells.begin(), result.cells.end());
    SingleSensorResult sensors = example_single_sensor(0, 0);
    std::reverse(sensors.sensors.begin(), sensors.sensors.end());
    write_single_sensor(database, 1, 0, sensors);
    write_fusion(database, 1, 1, result);
    EXPECT_EQ(check_hashes(database).problems, std::vector<std::string>{});
}

TEST(ContentHash, TheErrorsInWorldsMayComeInAnyPortions) {
    const TemporaryFolder folder;
    Database one = Database::open_or_create(folder / "one.db");
    Database other = Database::open_or_create(folder / "other.db");
    begin_study(one, world_description());
    begin_study(other, world_description());
    write_world_errors(one, 1, world_errors(0, 80));
    for (const auto& [first, last] : {std::pair{70, 80}, {0, 3}, {30, 70}, {3, 30}})
        write_world_errors(other, 1, world_errors(first, last));
    const std::string sql = "SELECT part || part_index || sha256 FROM content_hash ORDER BY 1";
    EXPECT_EQ(texts_from(one, sql), texts_from(other, sql));
    EXPECT_EQ(check_hashes(other).problems, std::vector<std::string>{});
}

TEST(ContentHash, WhatAStudyWasComputedWithIsStoredOnce) {
    const TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
    begin_study(database, example_study());
    write_computation(database, 1);
    write_computation(database, 1);
    write_computation(database, 1, {"AVX9", "a compiler", "0.9.0"});
    const auto computations = read_computations(database, 1);
    ASSERT_EQ(computations.size(), 2u);
    EXPECT_TRUE(computations[0] == this_computation() || computations[1] == this_computation());
    delete_study(database, 1);
    EXPECT_TRUE(read_computations(database, 1).empty());
}

}  // namespace
}  // namespace capstan::storage
