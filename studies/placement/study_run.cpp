#include "capstan/placement/study_run.h"

#include <set>

#include "capstan/placement/fusion_stage.h"
#include "capstan/placement/prepared_study.h"
#include "capstan/placement/recommendation.h"
#include "capstan/placement/repetition_blocks.h"
#include "capstan/placement/sensor_weights.h"
#include "capstan/placement/single_sensor_stage.h"
#include "capstan/placement/study_description.h"
#include "capstan/storage/study_store.h"

namespace capstan {

namespace {

// One run of a study, from whatever is already stored to its end.
class Run {
  public:
    Run(storage::Database& database, const PreparedStudy& study, std::int64_t study_id,
        const RunOptions& options, StudyTimes times)
        : database_(database), study_(study), study_id_(study_id), options_(options), times_(times) {
        for (const int unit : storage::pending_units(database, study_id)) pending_.insert(unit);
    }

    RunEnd work() {
        report();
        const int noise_levels = static_cast<int>(study_.plan.noise_levels.size());
        for (int noise = 0; noise < noise_levels; ++noise) {
            if (pending_at(noise) && !work_on_noise_level(noise)) return RunEnd::stopped;
        }
        conclude();
        return RunEnd::complete;
    }

    const StudyTimes& times() const { return times_; }

  private:
    int scenarios() const { return static_cast<int>(study_.scenarios.size()); }
    int single_sensor_unit(int noise, int scenario) const { return 2 * scenarios() * noise + scenario; }
    int fusion_unit(int noise, int scenario) const {
        return single_sensor_unit(noise, scenario) + scenarios();
    }

    bool pending_at(int noise) const {
        const auto next = pending_.lower_bound(single_sensor_unit(noise, 0));
        return next != pending_.end() && *next < single_sensor_unit(noise + 1, 0);
    }
    bool stop_asked() const { return options_.stop != nullptr && options_.stop->load(); }

    // What is stored already is solved again where the rest needs it, to the same bits; it is not written
    // again. False when asked to stop.
    bool work_on_noise_level(int noise) {
        std::vector<SolvedReadings> solved;
        std::vector<std::vector<double>> errors_N;  // scenarios x nodes
        for (int s = 0; s < scenarios(); ++s) {
            if (stop_asked()) return false;
            const StudyPoint point{s, noise};
            solved.push_back(solve_readings(study_, point, options_.jobs, times_.paper_methods_s));
            const double start_s = thread_processor_time_s();
            const auto result = summarise_sensors(study_, point, solved.back(), options_.jobs);
            times_.statistics_s += thread_processor_time_s() - start_s;
            errors_N.push_back(sensor_errors_N(result));
            store(single_sensor_unit(noise, s),
                  [&](int unit) { storage::write_single_sensor(database_, study_id_, unit, result); });
        }
        for (int s = 0; s < scenarios(); ++s) {
            if (pending_.count(fusion_unit(noise, s)) == 0) continue;
            if (stop_asked()) return false;
            FusionTimes times;
            const auto weight = sensor_weights(study_, errors_N, s);
            const auto result = fuse_readings(study_, {s, noise}, solved[s], weight, options_.jobs, times);
            times_.paper_methods_s += times.paper_methods_s;
            times_.feasible_curve_s += times.feasible_curve_s;
            times_.statistics_s += times.statistics_s;
            store(fusion_unit(noise, s),
                  [&](int unit) { storage::write_fusion(database_, study_id_, unit, result); });
        }
        return true;
    }

    template <typename Write>
    void store(int unit, const Write& write) {
        if (pending_.count(unit) == 0) return;
        const double start_s = wall_time_s();
        write(unit);
        times_.storage_s += wall_time_s() - start_s;
        pending_.erase(unit);
        report();
    }

    void conclude() {
        double start_s = wall_time_s();
        const auto recommendations = recommend(database_, study_id_, {study_.plan.worthwhile_gain_N});
        std::vector<storage::PaperComparisonRecord> paper;
        if (study_.plan.compare_with_paper && options_.compare_with_paper) {
            paper = options_.compare_with_paper(database_, study_id_);
        }
        times_.conclusions_s += wall_time_s() - start_s;
        start_s = wall_time_s();
        storage::finish_study(database_, study_id_, recommendations, paper);
        times_.storage_s += wall_time_s() - start_s;
    }

    void report() const {
        if (!options_.on_progress) return;
        const int units = 2 * scenarios() * static_cast<int>(study_.plan.noise_levels.size());
        options_.on_progress({units - static_cast<int>(pending_.size()), units});
    }

    storage::Database& database_;
    const PreparedStudy& study_;
    std::int64_t study_id_;
    const RunOptions& options_;
    StudyTimes times_;
    std::set<int> pending_;
};

RunOutcome work_on(storage::Database& database, const PreparedStudy& study, std::int64_t study_id,
                   const RunOptions& options, const StudyTimes& times, double start_wall_s) {
    Run run(database, study, study_id, options, times);
    RunOutcome outcome{study_id, run.work(), run.times()};
    outcome.times.wall_s = wall_time_s() - start_wall_s;
    return outcome;
}

}  // namespace

RunOutcome run_study(storage::Database& database, const StudyPlan& plan, const std::string& program_version,
                     const RunOptions& options) {
    const double start_wall_s = wall_time_s();
    StudyTimes times;
    double start_s = thread_processor_time_s();
    const PreparedStudy study = prepare(plan);
    times.prepare_s = thread_processor_time_s() - start_s;
    start_s = wall_time_s();
    const std::int64_t study_id = storage::begin_study(database, describe(study, program_version));
    times.storage_s = wall_time_s() - start_s;
    return work_on(database, study, study_id, options, times, start_wall_s);
}

RunOutcome resume_study(storage::Database& database, std::int64_t study_id, const StudyPlan& plan,
                        const RunOptions& options) {
    const double start_wall_s = wall_time_s();
    StudyTimes times;
    const double start_s = thread_processor_time_s();
    const PreparedStudy study = prepare(plan);
    times.prepare_s = thread_processor_time_s() - start_s;
    return work_on(database, study, study_id, options, times, start_wall_s);
}

}  // namespace capstan
