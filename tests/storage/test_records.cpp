// What goes in comes out, in every field.
#include <gtest/gtest.h>

#include <limits>

#include "capstan/storage/study_ids.h"
#include "capstan/storage/world_store.h"
#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

class Records : public testing::Test {
  protected:
    TemporaryFolder folder;
    Database database = Database::open_or_create(folder / "results.db");
};

TEST_F(Records, ADescriptionComesBackAsItWasWritten) {
    StudyDescription description = example_study();
    description.study.study_id = begin_study(database, description);
    EXPECT_EQ(load_study(database, description.study.study_id), description);
}

TEST_F(Records, TheSecondStudyOfAFileComesBackAsItWasWritten) {
    begin_study(database, example_study());
    StudyDescription second =
        example_study({.scenarios = 3, .noise_levels = 1, .sensor_sets = 5, .nodes = 4});
    second.study.study_id = begin_study(database, second);
    EXPECT_EQ(load_study(database, second.study.study_id), second);
}

TEST_F(Records, AStudyThatBeginsIsRunningWhateverItsDescriptionSays) {
    StudyDescription description = example_study();
    description.study.status = "complete";
    EXPECT_EQ(load_study(database, begin_study(database, description)).study.status, "running");
}

// As the schema says: what has an index is counted from 0 within its study.
TEST_F(Records, IndicesCountFromZero) {
    begin_study(database, example_study());
    StudyDescription worlds;
    worlds.study = {0, "worlds", "[uncertainty]", "0.1.0", 7, 40, 10, "running"};
    worlds.world_candidates = {{"[]", "no sensor", "", 0, 0.0}};
    begin_study(database, worlds);
    const std::int64_t study_id = begin_study(database, example_study());
    for (const int unit : pending_units(database, study_id)) write_unit(database, study_id, unit);
    finish_study(database, study_id, example_recommendations(), example_paper_comparison());
    for (const char* index :
         {"scenario_index FROM scenario", "noise_index FROM noise_level", "method_index FROM fusion_method",
          "set_index FROM sensor_set", "unit_index FROM work_unit", "candidate_index FROM world_candidate",
          "block FROM cell_block", "row_index FROM paper_comparison"})
        EXPECT_EQ(number_from(database, std::string("SELECT ") + index + " ORDER BY 1"), 0) << index;
}

TEST_F(Records, ListsOfNodesAreReadAsTheyAreWrittenAndNothingElseIs) {
    for (const std::vector<int>& nodes : {std::vector<int>{}, {3}, {1, 2, 31}}) {
        EXPECT_EQ(parse_node_list(node_list_text(nodes)), nodes);
    }
    EXPECT_EQ(node_list_text({1, 2, 31}), "[1,2,31]");
    EXPECT_EQ(parse_node_list("[1, 2]"), (std::vector<int>{1, 2}));
    expect_says(error_of([&] { parse_node_list("[1,two]"); }), "Not a list of nodes: [1,two]");
}

TEST_F(Records, AStudyOverWorldsComesBackAsItWasWritten) {
    StudyDescription worlds;
    worlds.study = {0, "worlds", "[uncertainty]", "0.1.0", 7, 40, 10, "running"};
    worlds.world_candidates = {{"[]", "no sensor", "", 0, 0.5}, {"[{}]", "tension at 0.6 m", "even", 1, 2.5}};
    worlds.study.study_id = begin_study(database, worlds);
    EXPECT_EQ(load_study(database, worlds.study.study_id), worlds);
    const std::vector<WorldErrorRecord> errors = {{0, "as_stated", 3, 0.1, 0.2, 0.3, 0.4, 0.95},
                                                  {1, "as_stated", 3, 0.5, 0.6, 0.7, 0.8, 0.94}};
    write_world_errors(database, 1, errors);
    EXPECT_EQ(read_world_errors(database, 1), errors);
    worlds.world_candidates.push_back({"[{},{}]", "two", "", 2, 5.5});
    add_world_candidate(database, 1, 2, worlds.world_candidates.back());
    EXPECT_EQ(load_study(database, 1), worlds);
    EXPECT_FALSE(read_world_recommendation(database, 1));
    const WorldRecommendationRecord recommendation{"all_nodes", 1, "ensemble_filter", 0.1, 0.2, 0.09, 0.11,
                                                   0.3,         1, "Use it."};
    finish_world_study(database, 1, recommendation);
    EXPECT_EQ(read_world_recommendation(database, 1), recommendation);
    EXPECT_EQ(load_study(database, 1).study.status, "complete");
}

TEST_F(Records, ErrorsByLayoutAreThoseOfTheirView) {
    const auto study_id = begin_study(database, example_study());
    for (const int unit : pending_units(database, study_id)) write_unit(database, study_id, unit);
    const auto errors = read_errors_by_layout(database, study_id, 1);
    Database reader = Database::open_read_only(folder / "results.db");
    const QueryResult expected = run_read_only(
        reader,
        "SELECT regime, family, sensor_count, method, mean_abs_error_N, standard_error_N FROM "
        "v_error_by_layout JOIN noise_level USING (noise_level_id) WHERE noise_index = 1 ORDER BY "
        "1, 2, 3, 4");
    std::vector<std::vector<QueryValue>> rows;
    for (const LayoutErrorSummary& error : errors)
        rows.push_back({error.regime, error.family, std::int64_t{error.sensor_count}, error.method,
                        error.mean_abs_error_N, error.standard_error_N});
    EXPECT_FALSE(rows.empty());
    EXPECT_EQ(rows, expected.rows);
}

// A number of a cell or recommendation tells its study; neither may run into the next one's.
TEST_F(Records, NumbersWithinAStudyEndBeforeThoseOfTheNext) {
    EXPECT_EQ(numbered_within_study(3, 0), 3'000'000'000);
    EXPECT_EQ(numbered_within_study(3, 999'999'999), numbered_within_study(4, 0) - 1);
    expect_says(error_of([&] { numbered_within_study(3, 1'000'000'000); }), "at most a billion");
    const std::vector<std::int64_t> ids{5, 7, 9};
    EXPECT_EQ(id_at(ids, 2, "sensor set"), 9);
    expect_says(error_of([&] { id_at(ids, 3, "sensor set"); }), "no sensor set 3: it has 3");
    expect_says(error_of([&] { id_at(ids, -1, "sensor set"); }), "no sensor set -1");
}

TEST_F(Records, AnySeedOfSixtyFourBitsComesBack) {
    for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1} << 63, ~std::uint64_t{0}}) {
        StudyDescription description = example_study();
        description.study.seed = seed;
        EXPECT_EQ(load_study(database, begin_study(database, description)).study.seed, seed);
    }
}

TEST_F(Records, SingleSensorResultsComeBackAsTheyWereWritten) {
    const auto study_id = begin_study(database, example_study());
    write_unit(database, study_id, 6);  // scenario 1, noise level 1
    EXPECT_EQ(read_single_sensor(database, study_id, 1, 1), example_single_sensor(1, 1).sensors);
    EXPECT_TRUE(read_single_sensor(database, study_id, 0, 1).empty());
}

TEST_F(Records, FusionResultsComeBackAsTheyWereWritten) {
    const auto study_id = begin_study(database, example_study());
    for (const int unit : {5, 7, 1, 3}) write_unit(database, study_id, unit);
    EXPECT_EQ(read_fusion(database, study_id, 1, 0), example_fusion(1, 0));
    EXPECT_EQ(read_fusion(database, study_id, 0, 1), example_fusion(0, 1));
}

TEST_F(Records, CellSummariesAreTheCellsOfOneNoiseLevelInTheOrderOfTheStudy) {
    const auto study_id = begin_study(database, example_study());
    for (const int unit : {7, 5, 3, 1}) write_unit(database, study_id, unit);
    const std::vector<CellSummary> summaries = read_cell_summaries(database, study_id, 1);
    ASSERT_EQ(summaries.size(), 12u);
    for (int scenario = 0, i = 0; scenario < 2; ++scenario) {
        for (const CellRecord& cell : example_fusion(scenario, 1).cells) {
            const CellSummary& summary = summaries[static_cast<std::size_t>(i++)];
            EXPECT_EQ(summary.scenario_index, scenario);
            EXPECT_EQ(summary.set_index, cell.set_index);
            EXPECT_EQ(summary.method, cell.method);
            EXPECT_EQ(summary.mean_abs_error_N, cell.mean_abs_error_N);
            EXPECT_EQ(summary.standard_error_N, cell.standard_error_N);
            EXPECT_EQ(summary.block_mean_abs_error_N, cell.block_mean_abs_error_N);
        }
    }
}

TEST_F(Records, ConclusionsComeBackAsTheyWereWritten) {
    const auto study_id = begin_study(database, example_study());
    for (const int unit : pending_units(database, study_id)) write_unit(database, study_id, unit);
    finish_study(database, study_id, example_recommendations(), example_paper_comparison());
    EXPECT_EQ(read_recommendations(database, study_id), example_recommendations());
    EXPECT_EQ(read_paper_comparison(database, study_id), example_paper_comparison());
}

TEST_F(Records, NotANumberIsRefusedAndNamesItsColumn) {
    const auto study_id = begin_study(database, example_study());
    FusionResult result = example_fusion(0, 0);
    result.cells.back().nodes.back().bias_N = std::numeric_limits<double>::quiet_NaN();
    const std::string message = error_of([&] { write_fusion(database, study_id, 1, result); });
    expect_says(message, "cell_node.bias_N");
    expect_says(message, "not a number");
    expect_says(message, "results.db");
}

}  // namespace
}  // namespace capstan::storage
