// A study is begun, its units are done once each, it is finished, it can go.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "capstan/storage/statement.h"
#include "capstan/storage/transaction.h"
#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

class StudyLife : public testing::Test {
  protected:
    TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");

    std::int64_t complete_study() {
        const auto study_id = begin_study(database, example_study());
        for (const int unit : pending_units(database, study_id)) write_unit(database, study_id, unit);
        finish_study(database, study_id, example_recommendations(), example_paper_comparison());
        return study_id;
    }
};

// table -> all its rows, in the order of their keys, in SQLite's own words for the values (17 digits).
std::map<std::string, std::string> tables_of(Database& database) {
    std::vector<std::string> names;
    Statement tables(
        database,
        "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT IN ('history', 'computed_with') ORDER BY name");
    while (tables.step()) names.push_back(tables.get<std::string>(0));
    std::map<std::string, std::string> content;
    for (const std::string& name : names) {
        Statement columns(
            database, "SELECT group_concat('quote(' || name || ')', '||'',''||') FROM pragma_table_info(?)");
        columns.bind(1, name);
        columns.step();
        Statement rows(database, "SELECT " + columns.get<std::string>(0) + " FROM " + name + " ORDER BY 1");
        while (rows.step()) content[name] += rows.get<std::string>(0) + "\n";
        content[name] += "end";
    }
    return content;
}

TEST_F(StudyLife, UnitsAreDoneOneByOneUntilTheStudyIsComplete) {
    const auto study_id = begin_study(database, example_study());
    EXPECT_EQ(pending_units(database, study_id), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
    write_unit(database, study_id, 3);
    EXPECT_EQ(pending_units(database, study_id), (std::vector<int>{0, 1, 2, 4, 5, 6, 7}));
    EXPECT_EQ(list_studies(database).at(0).units_done, 1);
    EXPECT_EQ(list_studies(database).at(0).units, 8);
    EXPECT_EQ(list_studies(database).at(0).status, "running");
    for (const int unit : pending_units(database, study_id)) write_unit(database, study_id, unit);
    finish_study(database, study_id, {}, {});
    EXPECT_EQ(list_studies(database).at(0).status, "complete");
    EXPECT_EQ(load_study(database, study_id).study.status, "complete");
}

TEST_F(StudyLife, AUnitIsWrittenOnce) {
    const auto study_id = begin_study(database, example_study());
    write_unit(database, study_id, 0);
    write_unit(database, study_id, 1);
    expect_says(error_of([&] { write_unit(database, study_id, 0); }), "done already");
    expect_says(error_of([&] { write_unit(database, study_id, 1); }), "done already");
    EXPECT_EQ(read_fusion(database, study_id, 0, 0), example_fusion(0, 0));
}

TEST_F(StudyLife, ResultsMustBeThoseOfTheirUnit) {
    const auto study_id = begin_study(database, example_study());
    expect_says(error_of([&] { write_fusion(database, study_id, 0, example_fusion(0, 0)); }),
                "is not the stage");
    expect_says(error_of([&] { write_fusion(database, study_id, 1, example_fusion(1, 0)); }),
                "is not the stage");
    expect_says(error_of([&] { write_fusion(database, study_id, 99, example_fusion(0, 0)); }),
                "does not exist");
    expect_says(error_of([&] { write_fusion(database, study_id, 1, example_fusion(7, 0)); }),
                "no scenario 7");
    expect_says(error_of([&] { write_fusion(database, 5, 1, example_fusion(0, 0)); }), "no study 5");
    EXPECT_EQ(pending_units(database, study_id).size(), 8u);
}

TEST_F(StudyLife, AUnitThatFailsInItsLastRowLeavesNothing) {
    const auto study_id = begin_study(database, example_study());
    const auto before = tables_of(database);
    FusionResult result = example_fusion(0, 0);
    result.cells.push_back(result.cells.front());  // the same cell twice
    EXPECT_THROW(write_fusion(database, study_id, 1, result), Error);
    result.cells.back().method = "no_such_method";
    expect_says(error_of([&] { write_fusion(database, study_id, 1, result); }), "no_such_method");
    EXPECT_EQ(tables_of(database), before);
    write_unit(database, study_id, 1);  // and the right results are still welcome
    EXPECT_EQ(read_fusion(database, study_id, 0, 0), example_fusion(0, 0));
}

TEST_F(StudyLife, ADescriptionThatBreaksARuleLeavesNothing) {
    StudyDescription description = example_study();
    description.layouts.back().set_index = 99;
    expect_says(error_of([&] { begin_study(database, description); }), "no sensor set 99");
    description = example_study();
    description.scenarios.back().regime = "partial_both";  // not among its regimes
    EXPECT_THROW(begin_study(database, description), Error);
    EXPECT_TRUE(list_studies(database).empty());
    EXPECT_EQ(number_from(database, "SELECT count(*) FROM scenario_node"), 0);
}

TEST_F(StudyLife, AStudyIsFinishedWhenEveryUnitIsDoneAndOnlyOnce) {
    const auto study_id = begin_study(database, example_study());
    write_unit(database, study_id, 0);
    expect_says(error_of([&] { finish_study(database, study_id, {}, {}); }), "7 of its work units");
    for (const int unit : pending_units(database, study_id)) write_unit(database, study_id, unit);
    finish_study(database, study_id, example_recommendations(), {});
    expect_says(error_of([&] { finish_study(database, study_id, example_recommendations(), {}); }),
                "already");
}

TEST_F(StudyLife, StoredAveragesEqualThoseOfTheRunningStudy) {
    complete_study();  // another one, so that there is something to confuse it with
    const auto study_id = begin_study(database, example_study());
    for (const int unit : pending_units(database, study_id)) write_unit(database, study_id, unit);
    const auto said = [&](const std::string& view) {
        Database reader = Database::open_read_only(folder / "results.db");
        return run_read_only(reader, "SELECT * FROM " + view +
                                         " WHERE study_id = " + std::to_string(study_id) +
                                         " ORDER BY study_id, regime, noise_level_id, 6, 7, 8")
            .rows;
    };
    std::map<std::string, std::vector<std::vector<QueryValue>>> before;
    for (const char* view : {"v_error_by_layout", "v_best_method", "v_single_sensor_matrix"}) {
        before[view] = said(view);
        EXPECT_FALSE(before[view].empty()) << view;
    }
    EXPECT_GT(number_from(database, "SELECT count(*) FROM v_running_layout_error"), 0);
    finish_study(database, study_id, {}, {});
    for (const auto& [view, rows] : before) EXPECT_TRUE(said(view) == rows) << view;
    EXPECT_EQ(number_from(database, "SELECT count(*) FROM v_running_layout_error"), 0);
    EXPECT_EQ(number_from(database, "SELECT count(*) FROM v_running_sensor_matrix"), 0);
}

TEST_F(StudyLife, ThereIsOneBestMethodPerCountAndItNeedsNoKnownDirection) {
    complete_study();
    EXPECT_EQ(
        number_from(database, "SELECT count(*) FROM v_best_method"),
        number_from(
            database,
            "SELECT count(*) FROM (SELECT DISTINCT study_id, regime, noise_level_id, family, sensor_count "
            "FROM v_error_by_layout WHERE knowledge <> 'direction_known')"));
    EXPECT_EQ(
        number_from(database,
                    "SELECT count(*) FROM v_best_method b JOIN v_error_by_layout e "
                    "USING (study_id, regime, noise_level_id, family, sensor_count) "
                    "WHERE e.knowledge <> 'direction_known' AND e.mean_abs_error_N < b.mean_abs_error_N"),
        0);
    EXPECT_EQ(number_from(database,
                          "SELECT count(*) FROM v_best_method JOIN fusion_method USING (study_id, method) "
                          "WHERE knowledge = 'direction_known'"),
              0);
}

TEST_F(StudyLife, DeletingAStudyRemovesItsRowsOnly) {
    const auto kept = complete_study();
    const auto before = tables_of(database);
    const auto gone = complete_study();
    ASSERT_NE(tables_of(database), before);
    delete_study(database, gone);
    EXPECT_EQ(tables_of(database), before);
    delete_study(database, kept);
    for (const auto& [table, rows] : tables_of(database)) EXPECT_EQ(rows, "end") << table;
    expect_says(error_of([&] { delete_study(database, kept); }), "no study");
}

TEST_F(StudyLife, AForgottenStudyLeavesNoHistory) {
    const auto kept = complete_study();
    const auto forgotten = complete_study();
    const auto count = [&](const char* table) {
        Statement rows(database, std::string("SELECT group_concat(DISTINCT study_id) FROM ") + table);
        rows.step();
        return rows.get<std::string>(0);
    };
    ASSERT_EQ(count("history"), std::to_string(kept) + "," + std::to_string(forgotten));
    forget_study(database, forgotten);
    EXPECT_EQ(count("study"), std::to_string(kept));
    EXPECT_EQ(count("history"), std::to_string(kept));
    EXPECT_THROW(forget_study(database, forgotten), Error);
}

TEST_F(StudyLife, TheOrderOfTheUnitsDoesNotChangeTheTables) {
    complete_study();
    Database other = Database::open_or_create(folder / "other.db");
    const auto study_id = begin_study(other, example_study());
    for (const int unit : {7, 2, 5, 0, 3, 6, 1, 4}) write_unit(other, study_id, unit);
    finish_study(other, study_id, example_recommendations(), example_paper_comparison());
    EXPECT_EQ(tables_of(other), tables_of(database));
}

TEST_F(StudyLife, InterleavedStudiesGiveTheSameTablesAsConsecutiveOnes) {
    complete_study();
    complete_study();
    Database other = Database::open_or_create(folder / "other.db");
    const auto first = begin_study(other, example_study());
    const auto second = begin_study(other, example_study());
    for (int unit = 0; unit < 8; ++unit) {
        write_unit(other, second, unit);
        write_unit(other, first, 7 - unit);
    }
    finish_study(other, second, example_recommendations(), example_paper_comparison());
    finish_study(other, first, example_recommendations(), example_paper_comparison());
    EXPECT_EQ(tables_of(other), tables_of(database));
}

TEST_F(StudyLife, AStudyIsFoundByIdByNameAndAsTheLatest) {
    expect_says(error_of([&] { find_study(database, "latest"); }), "capstan study run");
    begin_study(database, example_study());
    begin_study(database, example_study());
    StudyDescription third = example_study();
    third.study.name = "third";
    begin_study(database, third);
    EXPECT_EQ(find_study(database, "1"), 1);
    EXPECT_EQ(find_study(database, "example"), 2);
    EXPECT_EQ(find_study(database, "latest"), 3);
    third.study.name = "latest";  // takes the word from nobody
    begin_study(database, third);
    begin_study(database, example_study());
    EXPECT_EQ(find_study(database, "latest"), 5);
    const std::string message = error_of([&] { find_study(database, "forth"); });
    expect_says(message, "'forth'");
    expect_says(message, "1 (example, running), 2 (example, running), 3 (third, running)");
}

TEST_F(StudyLife, TheHistoryTellsWhatWasDoneInItsOrder) {
    const auto study_id = complete_study();
    annotate_study(database, study_id, "a note", std::nullopt);
    annotate_study(database, study_id, std::nullopt, "some tags");
    const StudySummary study = list_studies(database).at(0);
    EXPECT_EQ(study.note, "a note");
    EXPECT_EQ(study.tags, "some tags");
    EXPECT_EQ(study.name, "example");
    trash_study(database, study_id);
    EXPECT_TRUE(list_studies(database).empty());
    EXPECT_EQ(list_studies(database, Shelf::trash).at(0).study_id, study_id);
    expect_says(error_of([&] { find_study(database, "7", Shelf::trash); }),
                "has no deleted study '7'. It holds 1");
    restore_study(database, study_id);
    expect_says(error_of([&] { find_study(database, "7", Shelf::trash); }), "Its trash is empty.");
    delete_study(database, study_id);
    Statement events(database,
                     "SELECT group_concat(event) FROM (SELECT event FROM history ORDER BY event_id)");
    events.step();
    EXPECT_EQ(events.get<std::string>(0), "begun,completed,deleted,restored,removed");
}

TEST_F(StudyLife, TheHistoryNamesTheCommand) {
    set_command("capstan study run");
    begin_study(database, example_study());
    set_command("");
    begin_study(database, example_study());
    Statement commands(database, "SELECT group_concat(command || '.') FROM history");
    commands.step();
    EXPECT_EQ(commands.get<std::string>(0), "capstan study run.,.");
}

TEST_F(StudyLife, NothingIsSaidAboutAStudyThatIsNotThere) {
    expect_says(error_of([&] { annotate_study(database, 3, "a note", std::nullopt); }), "holds no study 3");
    expect_says(error_of([&] { trash_study(database, 3); }), "holds no study 3");
    EXPECT_EQ(number_from(database, "SELECT count(*) FROM history"), 0);
}

TEST_F(StudyLife, ATransactionThatIsNotCommittedLeavesNothing) {
    begin_study(database, example_study());
    {
        Transaction transaction(database);
        database.execute("DELETE FROM study", "test");
    }
    EXPECT_EQ(list_studies(database).size(), 1u);
}

}  // namespace
}  // namespace capstan::storage
