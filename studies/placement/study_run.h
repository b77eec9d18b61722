#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "capstan/plan/study_plan.h"
#include "capstan/storage/database.h"
#include "capstan/storage/records.h"

namespace capstan {

/// Progress of a run; reported from the thread that runs the study, after every stored unit.
struct StudyProgress {
    int units_done = 0;
    int units = 0;
};

/// Processor time [s] of each stage, summed over threads, and wall time [s] of the run.
struct StudyTimes {
    double prepare_s = 0.0;         ///< true motion, estimators' tables
    double paper_methods_s = 0.0;   ///< readings, single-sensor estimates, votes, the paper's fusion methods
    double feasible_curve_s = 0.0;  ///< likelihoods, maximum likelihood, posterior mean
    double statistics_s = 0.0;
    double storage_s = 0.0;      ///< wall time: one writer
    double conclusions_s = 0.0;  ///< recommendations and the paper's table
    double wall_s = 0.0;
};

struct RunOptions {
    int jobs = 0;  ///< threads; 0: all processors
    std::function<void(const StudyProgress&)> on_progress;
    const std::atomic<bool>* stop = nullptr;  ///< set it to stop after the unit under way
    /// The paper's numbers beside ours, read from the stored cells; called for plans that compare with it.
    std::function<std::vector<storage::PaperComparisonRecord>(storage::Database&, std::int64_t study_id)>
        compare_with_paper;
};

enum class RunEnd { complete, stopped };

struct RunOutcome {
    std::int64_t study_id = 0;
    RunEnd end = RunEnd::complete;
    StudyTimes times;
};

/// Runs a study from its beginning into the database. Throws InvalidInput if the plan has problems; nothing
/// is written then.
RunOutcome run_study(storage::Database& database, const StudyPlan& plan, const std::string& program_version,
                     const RunOptions& options);

/// Runs several studies one after the other, as one run: all are begun in the database before the first draw,
/// so that a killed run can be resumed, study by study. The outcome's study_id is that of the last study
/// worked on.
RunOutcome run_studies(storage::Database& database, std::span<const StudyPlan> plans,
                       const std::string& program_version, const RunOptions& options);

/// Goes on with a study that was killed or stopped: the units that are stored stay, the others are run, and
/// the tables end with the same bits as without the interruption. `plan` is what the stored configuration
/// says.
RunOutcome resume_study(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                        const RunOptions& options);

/// Draws the conclusions of a study whose units are all stored (recommendations, the paper's table) and marks
/// it complete, in one transaction. Adds to `times`. Throws storage::Error if a unit is not done.
void conclude_study(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                    const RunOptions& options, StudyTimes& times);

}  // namespace capstan
