// Writing must not be what a study waits for.
#include <gtest/gtest.h>

#include <chrono>

#include "example_study.h"
#include "temporary_results.h"

namespace capstan::storage {
namespace {

// The paper's study: about 1200 cells of 11 nodes and 40 blocks, 62,400 rows. The limit is ten times what an
// idle 2-core machine takes, so that only a lost prepared statement or a transaction per row breaks it.
TEST(Speed, ThePaperStudyIsWrittenWithinTheTimeLimit) {
    const TemporaryFolder folder;
    const ExampleSize paper{.scenarios = 12, .noise_levels = 1, .sensor_sets = 50, .nodes = 11, .blocks = 40};
    Database database = Database::open_or_create(folder / "results.db");
    const auto study_id = begin_study(database, example_study(paper));
    std::vector<FusionResult> results;
    for (int scenario = 0; scenario < paper.scenarios; ++scenario) {
        results.push_back(example_fusion(scenario, 0, paper));
    }

    const auto start = std::chrono::steady_clock::now();
    for (const FusionResult& result : results) {
        write_fusion(database, study_id, 2 * result.scenario_index + 1, result);
    }
    const std::chrono::duration<double> writing_s = std::chrono::steady_clock::now() - start;
    const auto read_start = std::chrono::steady_clock::now();
    EXPECT_EQ(read_cell_summaries(database, study_id, 0).size(), 1200u);
    const std::chrono::duration<double> reading_s = std::chrono::steady_clock::now() - read_start;

    RecordProperty("writing_ms", static_cast<int>(1000 * writing_s.count()));
    RecordProperty("reading_ms", static_cast<int>(1000 * reading_s.count()));
    EXPECT_LT(writing_s.count(), 1.5);
    EXPECT_LT(reading_s.count(), 0.5);
}

}  // namespace
}  // namespace capstan::storage
