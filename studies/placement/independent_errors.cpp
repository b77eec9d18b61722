#include "capstan/placement/independent_errors.h"

#include <algorithm>

#include "capstan/placement/fusion_stage.h"
#include "capstan/placement/single_sensor_stage.h"
#include "capstan/storage/study_store.h"

namespace capstan {

namespace {

template <class Value>
std::size_t place_in(std::vector<Value>& list, const Value& value) {
    const auto seen = std::find(list.begin(), list.end(), value);
    if (seen != list.end()) return static_cast<std::size_t>(seen - list.begin());
    list.push_back(value);
    return list.size() - 1;
}

std::vector<std::vector<double>> stored_sensor_errors_N(storage::Database& database, std::int64_t study_id,
                                                        int scenarios, int noise_index) {
    std::vector<std::vector<double>> errors_N;
    for (int s = 0; s < scenarios; ++s) {
        errors_N.push_back(sensor_errors_N(
            {s, noise_index, storage::read_single_sensor(database, study_id, s, noise_index)}));
    }
    return errors_N;
}

StudyPlan with_independent_repetitions(StudyPlan plan) {
    plan.repetitions = std::min(plan.repetitions, max_independent_repetitions);
    return plan;
}

std::vector<PlacementCandidate> errors_on_independent_draws(storage::Database& database,
                                                            std::int64_t study_id, const StudyPlan& plan,
                                                            int jobs, int noise_index,
                                                            std::vector<PlacementCandidate> chosen) {
    const StudyPlan independent_plan = with_independent_repetitions(plan);
    PreparedStudy study = prepare(independent_plan);
    const std::vector<std::vector<int>> all_sets = std::move(study.sensor_sets);
    study.sensor_sets.clear();
    study.methods.clear();
    std::vector<std::size_t> set_of;
    std::vector<std::size_t> method_of;
    for (PlacementCandidate& candidate : chosen) {
        set_of.push_back(place_in(study.sensor_sets, all_sets.at(candidate.set_index)));
        method_of.push_back(place_in(study.methods, find_fusion_method(candidate.method)));
        candidate.error_N.clear();
        candidate.block_error_N.clear();
    }
    const int scenarios = static_cast<int>(study.scenarios.size());
    const auto errors_N = stored_sensor_errors_N(database, study_id, scenarios, noise_index);
    for (int s = 0; s < scenarios; ++s) {
        const StudyPoint point{s, noise_index, independent_draws};
        double processor_time_s = 0.0;
        FusionTimes times;
        const SolvedReadings solved = study.uses(Knowledge::direction_unknown)
                                          ? solve_readings(study, point, jobs, processor_time_s)
                                          : only_readings(study, point);
        const auto result =
            fuse_readings(study, point, solved, sensor_weights(study, errors_N, s), jobs, times);
        for (std::size_t k = 0; k < chosen.size(); ++k) {
            const auto& cell = result.cells[set_of[k] * study.methods.size() + method_of[k]];
            chosen[k].error_N.push_back(cell.mean_abs_error_N);
            chosen[k].block_error_N.push_back(cell.block_mean_abs_error_N);
        }
    }
    return chosen;
}

}  // namespace

IndependentErrors independent_errors(storage::Database& database, std::int64_t study_id,
                                     const StudyPlan& plan, int jobs) {
    return
        [&database, study_id, &plan, jobs](int noise_index, const std::vector<PlacementCandidate>& chosen) {
            return errors_on_independent_draws(database, study_id, plan, jobs, noise_index, chosen);
        };
}

}  // namespace capstan
