#include "capstan/placement/unit_run.h"

#include <algorithm>

#include "capstan/placement/fusion_stage.h"
#include "capstan/placement/single_sensor_stage.h"
#include "capstan/platform/clocks.h"
#include "capstan/storage/error.h"
#include "capstan/storage/study_store.h"

namespace capstan {

namespace {

class UnitRun {
  public:
    UnitRun(storage::Database& database, const PreparedStudy& study, UnitsToRun work,
            const RunOptions& options, StudyTimes& times)
        : database_(database), study_(study), work_(std::move(work)), options_(options), times_(times) {}

    RunEnd run() {
        const int noise_levels = static_cast<int>(study_.plan.noise_levels.size());
        for (int noise = 0; noise < noise_levels; ++noise) {
            if (!work_on_noise_level(noise)) return RunEnd::stopped;
        }
        return RunEnd::complete;
    }

  private:
    int scenarios() const { return static_cast<int>(study_.scenarios.size()); }
    bool stop_requested() const { return options_.stop != nullptr && options_.stop->load(); }
    bool wants(int unit) const { return work_.units.count(unit) != 0; }
    bool wants_fusion(int noise, int s) const { return wants(fusion_unit(study_, noise, s)); }

    // For its own units, or for the weights of others.
    bool needs_readings(int noise, int s) const {
        if (wants(single_sensor_unit(study_, noise, s)) || wants_fusion(noise, s)) return true;
        for (int fused = 0; fused < scenarios(); ++fused) {
            if (wants_fusion(noise, fused) && gives_weights(study_, s, fused)) return true;
        }
        return false;
    }

    // False if a stop was requested.
    bool work_on_noise_level(int noise) {
        std::vector<SolvedReadings> solved(scenarios());
        std::vector<std::vector<double>> errors_N(scenarios());  // scenarios x nodes; empty: not needed
        for (int s = 0; s < scenarios(); ++s) {
            if (!needs_readings(noise, s)) continue;
            if (stop_requested()) return false;
            const StudyPoint point{s, noise};
            SolvedReadings readings = solve_readings(study_, point, options_.jobs, times_.paper_methods_s);
            const double start_s = thread_processor_time_s();
            const auto result = summarise_sensors(study_, point, readings, options_.jobs);
            times_.statistics_s += thread_processor_time_s() - start_s;
            errors_N[s] = sensor_errors_N(result);
            if (wants_fusion(noise, s)) solved[s] = std::move(readings);
            store(single_sensor_unit(study_, noise, s),
                  [&](int unit) { storage::write_single_sensor(database_, work_.study_id, unit, result); });
        }
        for (int s = 0; s < scenarios(); ++s) {
            if (!wants_fusion(noise, s)) continue;
            if (stop_requested()) return false;
            FusionTimes times;
            const auto weight = sensor_weights(study_, errors_N, s);
            const auto result = fuse_readings(study_, {s, noise}, solved[s], weight, options_.jobs, times);
            times_.paper_methods_s += times.paper_methods_s;
            times_.feasible_curve_s += times.feasible_curve_s;
            times_.statistics_s += times.statistics_s;
            store(fusion_unit(study_, noise, s),
                  [&](int unit) { storage::write_fusion(database_, work_.study_id, unit, result); });
        }
        return true;
    }

    template <typename Write>
    void store(int unit, const Write& write) {
        if (!wants(unit)) return;
        const double start_s = wall_time_s();
        try {
            write(unit);
        } catch (const storage::Error&) {
            if (!work_.shared_with_others || !is_stored(unit)) throw;
        }
        times_.storage_s += wall_time_s() - start_s;
        work_.units.erase(unit);
        if (work_.on_stored) work_.on_stored();
    }

    bool is_stored(int unit) {
        const auto pending = storage::pending_units(database_, work_.study_id);
        return std::find(pending.begin(), pending.end(), unit) == pending.end();
    }

    storage::Database& database_;
    const PreparedStudy& study_;
    UnitsToRun work_;
    const RunOptions& options_;
    StudyTimes& times_;
};

}  // namespace

int single_sensor_unit(const PreparedStudy& study, int noise_index, int scenario_index) {
    return 2 * static_cast<int>(study.scenarios.size()) * noise_index + scenario_index;
}

int fusion_unit(const PreparedStudy& study, int noise_index, int scenario_index) {
    return single_sensor_unit(study, noise_index, scenario_index) + static_cast<int>(study.scenarios.size());
}

RunEnd run_units(storage::Database& database, const PreparedStudy& study, UnitsToRun work,
                 const RunOptions& options, StudyTimes& times) {
    return UnitRun(database, study, std::move(work), options, times).run();
}

}  // namespace capstan
