// What the examination of a file counts and finds, and with what its studies were computed.

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "capstan/storage/database.h"
#include "capstan/storage/diagnosis_store.h"
#include "capstan/storage/health.h"
#include "capstan/storage/integrity/computed_with.h"
#include "capstan/storage/study_store.h"
#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

class Examination : public testing::Test {
  protected:
    Health examined() {
        Database reader = Database::open_read_only(folder / "results.db", SchemaCheck::none);
        return examine(reader);
    }
    std::int64_t finished_study() {
        const std::int64_t study_id = begin_study(database, example_study());
        for (const int unit : pending_units(database, study_id)) write_unit(database, study_id, unit);
        finish_study(database, study_id, example_recommendations(), example_paper_comparison());
        return study_id;
    }
    TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
};

TEST_F(Examination, OfAnEmptyFileCountsNothingAndFindsNothing) {
    const Health health = examined();
    EXPECT_TRUE(health.problems.empty());
    EXPECT_EQ(health.studies + health.running_studies + health.diagnoses + health.cells + health.hashed_parts,
              0);
    EXPECT_TRUE(health.unhashed.empty());
    EXPECT_TRUE(health.copies.empty());
}

TEST_F(Examination, CountsStudiesDiagnosesAndCells) {
    finished_study();
    StudyDescription other = example_study();
    other.study.name = "another";
    begin_study(database, other);
    const Health health = examined();
    EXPECT_TRUE(health.problems.empty());
    EXPECT_EQ(health.studies, 2);
    EXPECT_EQ(health.running_studies, 1);
    EXPECT_EQ(health.diagnoses, 0);
    EXPECT_EQ(health.cells, number_from(database, "SELECT count(*) FROM cell"));
    EXPECT_GT(health.cells, 1);
    EXPECT_GT(health.hashed_parts, 1);
}

TEST_F(Examination, FindsAStudyCalledCompleteWithAUnitThatIsNotDone) {
    finished_study();
    database.execute("UPDATE work_unit SET done = 0 WHERE unit_index = 1", "undo a unit");
    const auto problems = examined().problems;
    ASSERT_FALSE(problems.empty());
    EXPECT_EQ(problems.front(), "a study is called complete, but some of its units are not done");
}

TEST_F(Examination, NamesBothTablesOfAReferenceToNothing) {
    begin_study(database, example_study());
    database.execute("PRAGMA foreign_keys = OFF; UPDATE work_unit SET study_id = 77 WHERE unit_index = 0",
                     "tear a reference");
    const auto problems = examined().problems;
    ASSERT_FALSE(problems.empty());
    EXPECT_EQ(problems.front(), "a row of table work_unit refers to nothing in study");
}

TEST_F(Examination, NamesTwentyProblemsAtMostOfTornReferences) {
    begin_study(database, example_study({.noise_levels = 20, .sensor_sets = 3, .nodes = 3, .blocks = 4}));
    database.execute("PRAGMA foreign_keys = OFF; DELETE FROM study", "tear all references");
    EXPECT_EQ(examined().problems.size(), 20u);
}

// An index without entries: no value of the file is another one, and queries that go through it miss rows.
TEST_F(Examination, NamesAnIndexThatLostItsEntries) {
    const auto path = folder / "damaged.db";
    std::int64_t begin = 0;
    {
        Database file = Database::open_or_create(path, Journal::rollback);
        begin_study(file, example_study());
        begin = number_from(file,
                            "SELECT (rootpage - 1) * page_size FROM sqlite_schema, pragma_page_size WHERE "
                            "name = 'layout_of_set'");
    }
    std::fstream bytes(path, std::ios::binary | std::ios::in | std::ios::out);
    bytes.seekp(begin + 3);
    bytes.write("\0\0", 2);  // how many entries the page has
    bytes.close();
    Database reader = Database::open_read_only(path, SchemaCheck::none);
    const auto problems = examine(reader).problems;
    EXPECT_TRUE(std::any_of(problems.begin(), problems.end(), [](const std::string& problem) {
        return problem.find("index layout_of_set") != std::string::npos;
    })) << testing::PrintToString(problems);
}

TEST_F(Examination, ReportsWhatTheHashesFind) {
    finished_study();
    database.execute(
        "UPDATE cell SET mean_abs_error_N = 2 * mean_abs_error_N WHERE cell_id = "
        "(SELECT max(cell_id) FROM cell)",
        "damage a number");
    const auto problems = examined().problems;
    ASSERT_EQ(problems.size(), 1u);
    expect_says(problems.front(), "table cell is not as it was written");
}

TEST_F(Examination, ListsTheCopiesOfOlderVersionsInOrder) {
    std::vector<std::string> copies;
    for (const char version : std::string("123456789"))
        copies.push_back(std::string("results.db.version") + version);
    for (auto name = copies.rbegin(); name != copies.rend(); ++name)
        std::ofstream(folder / *name) << "a copy";
    for (const char* name : {"other.db.version3", "results.txt"}) std::ofstream(folder / name) << "no copy";
    EXPECT_EQ(examined().copies, copies);
}

class ComputedWith : public Examination {
  protected:
    // A file of its own with a study that was computed with these, one after the other.
    Database computed(const char* name, const std::vector<Computation>& computations) {
        Database file = Database::open_or_create(folder / name);
        begin_study(file, example_study());
        for (const Computation& computation : computations) write_computation(file, 1, computation);
        return file;
    }
    const Computation here = this_computation();
    const Computation elsewhere{"AVX9", here.compiler, here.program_version};
};

TEST_F(ComputedWith, AStudyOfAnotherWidthIsNotGoneOnWith) {
    Database same = computed("same.db", {here});
    EXPECT_EQ(other_simd(same, 1), std::nullopt);
    EXPECT_NO_THROW(require_same_simd(same, 1));
    Database other = computed("other.db", {here, elsewhere});
    EXPECT_EQ(other_simd(other, 1), "AVX9");
    expect_says(error_of([&] { require_same_simd(other, 1); }),
                "was begun with SIMD AVX9, and this is " + here.simd);
}

TEST_F(ComputedWith, FilesAreJoinedOnlyIfOneProgramComputedThem) {
    Database first = computed("first.db", {here});
    Database silent = computed("silent.db", {});
    Database second = computed("second.db", {here});
    Database other = computed("other.db", {elsewhere});
    Database mixed = computed("mixed.db", {here, elsewhere});
    SameComputation same;
    EXPECT_EQ(same.problem_of(silent), "");
    EXPECT_EQ(same.common(), std::nullopt);
    EXPECT_NO_THROW(same.require_same_simd_here());
    EXPECT_EQ(same.problem_of(first), "");
    EXPECT_EQ(same.common(), here);
    EXPECT_EQ(same.problem_of(second), "");
    EXPECT_NO_THROW(same.require_same_simd_here());
    const std::string problem = same.problem_of(other);
    expect_says(problem, "was computed with " + words_of(elsewhere) + ", but " +
                             (folder / "first.db").string() + " with " + words_of(here));
    const bool here_first = here.simd < elsewhere.simd;
    expect_says(same.problem_of(mixed), "was computed partly with " +
                                            words_of(here_first ? here : elsewhere) + " and partly with " +
                                            words_of(here_first ? elsewhere : here));
}

TEST_F(ComputedWith, FilesOfAnotherWidthAreNotJoinedHere) {
    Database other = computed("other.db", {elsewhere});
    SameComputation same;
    EXPECT_EQ(same.problem_of(other), "");
    expect_says(error_of([&] { same.require_same_simd_here(); }), "were computed with SIMD AVX9");
}

}  // namespace
}  // namespace capstan::storage
