#pragma once
// Answers to: where do the sensors go, and what would change that?

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "capstan/estimate/cycle_trial.h"
#include "capstan/platform/wrapped_text.h"
#include "capstan/reports/answer.h"
#include "capstan/search/placement_answer.h"
#include "capstan/search/shared_budget.h"
#include "capstan/sensitivity/advice_sensitivity.h"
#include "capstan/sensitivity/world_sensitivity.h"
#include "capstan/storage/database.h"
#include "capstan/storage/records.h"
#include "capstan/worlds/band_coverage.h"
#include "capstan/worlds/world_study.h"

namespace capstan::answers {

/// What `capstan place` found.
reports::Answer place_answer(const StudyPlan& plan, const PlacementAnswer& found);

/// What a cable gets for a number of sensors.
struct BudgetChoice {
    Estimated error{
        std::numeric_limits<double>::infinity()};  ///< infinite: the constraints allow no such set
    std::vector<int> nodes{};                      ///< from 0; none over worlds
    std::string set{};                             ///< over worlds, in words
    std::string method{};                          ///< that fuses the readings; empty without any
};
/// One cable of several that share a budget of sensors.
struct BudgetCable {
    std::string name;
    Cable cut;                          ///< whose nodes are counted
    std::vector<BudgetChoice> choices;  ///< by number of sensors from 0
};
/// `no_sensor_N`: the error without a sensor, where none is required.
BudgetCable budget_cable(const StudyPlan& plan, const PlacementAnswer& found, double no_sensor_N,
                         int sensors);
BudgetCable budget_cable(const StudyPlan& plan, const WorldAnswer& found, int sensors);

/// What `capstan budget` found; the last of `shares` is the answer.
reports::Answer budget_answer(const std::vector<BudgetCable>& cables, const std::vector<BudgetShare>& shares,
                              BudgetObjective objective);

/// How often the 95% bands of a configuration's sets hold the true tension.
struct ConfigurationBands {
    StudyPlan plan;
    std::vector<std::string> sets{};  ///< in words
    std::vector<BandCoverage> bands;
    int worlds = 0;
};
/// What `capstan bands` found.
reports::Answer band_answer(const std::vector<ConfigurationBands>& configurations);

/// What `capstan sensitivity` found.
reports::Answer sensitivity_answer(const StudyPlan& plan, const sensitivity::SensitivityAnswer& found);

/// The same for a study over worlds.
reports::Answer world_sensitivity_answer(const StudyPlan& plan, const sensitivity::WorldSensitivity& found);

/// What a complete study concludes.
struct Conclusions {
    std::int64_t study_id = 0;
    storage::StudyDescription study;
    std::vector<storage::RecommendationRecord> recommendations;
    std::vector<storage::PaperComparisonRecord> paper_comparison;
};
/// Throws storage::Error, with the command that completes it, if the study is not complete.
void require_complete(storage::Database& database, std::int64_t study_id,
                      const storage::StudyDescription& description);
Conclusions read_conclusions(storage::Database& database, std::int64_t study_id);
/// `plan`: of the study.
reports::Answer recommendation_answer(const Conclusions& conclusions, const StudyPlan& plan);

/// What a study over worlds found; `study_id` 0: it is not stored.
reports::Answer world_answer(const StudyPlan& plan, const WorldAnswer& found, std::int64_t study_id = 0);
/// Whether the advice changes where the worlds lie about `told.truth` instead of the nominal cable. Both
/// answers compare the same sets.
reports::Answer world_truth_answer(const StudyPlan& told, const WorldAnswer& nominal,
                                   const WorldAnswer& about_truth);
/// The same as world_answer() from a complete stored study, with the plan that it stored but for
/// `worthwhile_gain_N`.
reports::Answer stored_world_answer(storage::Database& database, std::int64_t study_id,
                                    const StudyPlan& plan);
/// What a complete study concludes, of either kind. Throws storage::Error if it is not complete.
reports::Answer conclusions_answer(storage::Database& database, std::int64_t study_id);

/// Whether the advice of a study changes where the true cable differs from the model; `model_id` and
/// `truth_id` are the two studies, with the same plan but for the true cable.
reports::Answer truth_answer(storage::Database& database, std::int64_t model_id, std::int64_t truth_id);

/// Each layout of a study scored over the complete motion.
reports::Answer cycle_answer(const StudyPlan& plan, const std::vector<estimate::CycleScore>& scores,
                             int repetitions);

/// Nodes as people count them, from 1.
std::vector<int> from_one(std::vector<int> nodes);
/// A fusion method's title; its name where the catalogue does not know it.
std::string title_of_method(const std::string& name);
/// The nodes of a set, from 1, and the label of a noise level, that a recommendation of the study names.
/// Throws storage::Error where the study has none with that index.
const std::vector<int>& nodes_of(const storage::StudyDescription& study, int set_index);
const std::string& noise_label(const storage::StudyDescription& study, int noise_index);
/// An estimate with its 95% interval.
reports::Data estimate_data(const IntervalEstimate& estimate);

}  // namespace capstan::answers
