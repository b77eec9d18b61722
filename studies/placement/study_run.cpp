#include "capstan/placement/study_run.h"

#include "capstan/placement/prepared_study.h"
#include "capstan/placement/recommendation.h"
#include "capstan/placement/stored_study.h"
#include "capstan/placement/unit_run.h"
#include "capstan/platform/clocks.h"
#include "capstan/storage/integrity/computed_with.h"
#include "capstan/storage/study_store.h"

namespace capstan {

namespace {

int units_of(const PreparedStudy& study) {
    return 2 * static_cast<int>(study.scenarios.size()) * static_cast<int>(study.plan.noise_levels.size());
}

// From whatever is already stored to the end; counts on in `progress`, in which the study's own stored units
// are not counted yet. Adds to `times`.
RunEnd work_on(storage::Database& database, const PreparedStudy& study, std::int64_t study_id,
               const RunOptions& options, StudyProgress& progress, StudyTimes& times) {
    UnitsToRun work{study_id, {}, {}};
    for (const int unit : storage::pending_units(database, study_id)) work.units.insert(unit);
    progress.units_done += units_of(study) - static_cast<int>(work.units.size());
    const auto report = [&] {
        if (options.on_progress) options.on_progress(progress);
    };
    work.on_stored = [&] {
        ++progress.units_done;
        report();
    };
    report();
    storage::write_computation(database, study_id);
    const RunEnd end = run_units(database, study, std::move(work), options, times);
    if (end == RunEnd::complete) conclude_study(database, study_id, study.plan, options, times);
    return end;
}

}  // namespace

RunOutcome run_study(storage::Database& database, const StudyPlan& plan, const std::string& program_version,
                     const RunOptions& options) {
    return run_studies(database, {&plan, 1}, program_version, options);
}

RunOutcome run_studies(storage::Database& database, std::span<const StudyPlan> plans,
                       const std::string& program_version, const RunOptions& options) {
    const double start_wall_s = wall_time_s();
    RunOutcome outcome;
    StudyTimes& times = outcome.times;
    double start_s = thread_processor_time_s();
    std::vector<PreparedStudy> studies;
    for (const StudyPlan& plan : plans) studies.push_back(prepare(plan));
    times.prepare_s = thread_processor_time_s() - start_s;

    start_s = wall_time_s();
    StudyProgress progress;
    std::vector<std::int64_t> ids;
    for (const PreparedStudy& study : studies) {
        ids.push_back(storage::begin_study(database, describe(study, program_version)));
        progress.units += units_of(study);
    }
    times.storage_s = wall_time_s() - start_s;
    for (std::size_t k = 0; k < studies.size() && outcome.end == RunEnd::complete; ++k) {
        outcome.study_id = ids[k];
        outcome.end = work_on(database, studies[k], ids[k], options, progress, times);
    }
    times.wall_s = wall_time_s() - start_wall_s;
    return outcome;
}

RunOutcome resume_study(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                        const RunOptions& options) {
    const double start_wall_s = wall_time_s();
    RunOutcome outcome;
    outcome.study_id = study_id;
    const double start_s = thread_processor_time_s();
    const PreparedStudy study = prepare(plan);
    outcome.times.prepare_s = thread_processor_time_s() - start_s;
    StudyProgress progress{0, units_of(study)};
    outcome.end = work_on(database, study, study_id, options, progress, outcome.times);
    outcome.times.wall_s = wall_time_s() - start_wall_s;
    return outcome;
}

void conclude_study(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                    const RunOptions& options, StudyTimes& times) {
    double start_s = wall_time_s();
    const auto recommendations =
        recommend(database, study_id, {plan.worthwhile_gain_N, no_sensor_errors_N(plan)},
                  independent_errors(database, study_id, plan, options.jobs));
    std::vector<storage::PaperComparisonRecord> paper;
    if (plan.compare_with_paper && options.compare_with_paper) {
        paper = options.compare_with_paper(database, study_id);
    }
    times.conclusions_s += wall_time_s() - start_s;
    start_s = wall_time_s();
    storage::write_computation(database, study_id);
    storage::finish_study(database, study_id, recommendations, paper);
    times.storage_s += wall_time_s() - start_s;
}

}  // namespace capstan
