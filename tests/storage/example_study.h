#pragma once
// A small study with a different value in every field, and results for its units.

#include "capstan/storage/study_store.h"

namespace capstan::storage {

struct ExampleSize {
    int scenarios = 2;
    int noise_levels = 2;
    int sensor_sets = 3;
    int nodes = 3;
    int blocks = 4;
};

// Units alternate: single_sensor then fusion, scenario by scenario, noise level by noise level.
StudyDescription example_study(const ExampleSize& size = {});

SingleSensorResult example_single_sensor(int scenario_index, int noise_index, const ExampleSize& size = {});
FusionResult example_fusion(int scenario_index, int noise_index, const ExampleSize& size = {});
std::vector<RecommendationRecord> example_recommendations();
std::vector<PaperComparisonRecord> example_paper_comparison();

// Writes the results of one unit of the example.
void write_unit(Database& database, std::int64_t study_id, int unit_index, const ExampleSize& size = {});

}  // namespace capstan::storage
