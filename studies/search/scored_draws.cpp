#include "capstan/search/scored_draws.h"

#include <algorithm>

namespace capstan {

ScoredDraws::ScoredDraws(const PreparedStudy& study, int noise_index, std::uint32_t first_draw,
                         const CandidateList& candidates, PlacementObjective objective)
    : study_(study),
      noise_index_(noise_index),
      first_draw_(first_draw),
      candidates_(candidates),
      objective_(objective),
      errors_(study.scenarios.size()),
      scenarios_(study.scenarios.size()) {}

std::vector<std::vector<double>> ScoredDraws::weights(const PreparedStudy& study, int noise_index, int jobs) {
    const int scenarios = static_cast<int>(study.scenarios.size());
    const bool needed = std::any_of(study.methods.begin(), study.methods.end(),
                                    [](const FusionMethod* method) { return method->uses_weights; });
    if (!needed) {
        return std::vector<std::vector<double>>(scenarios, std::vector<double>(study.nodes(), 1.0));
    }
    std::vector<std::vector<double>> errors_N;  // scenarios x nodes
    double processor_time_s = 0.0;
    for (int s = 0; s < scenarios; ++s) {
        const StudyPoint point{s, noise_index};
        const SolvedReadings solved = solve_readings(study, point, jobs, processor_time_s);
        errors_N.push_back(sensor_errors_N(summarise_sensors(study, point, solved, jobs)));
    }
    std::vector<std::vector<double>> weights;
    for (int s = 0; s < scenarios; ++s) weights.push_back(sensor_weights(study, errors_N, s));
    return weights;
}

void ScoredDraws::extend(const DrawBlocks& blocks, const std::vector<std::vector<double>>& weights,
                         int jobs) {
    const int first_block = blocks_.count();
    blocks_ = blocks;
    for (int s = 0; s < static_cast<int>(errors_.size()); ++s) {
        const StudyPoint point{s, noise_index_, first_draw_};
        double processor_time_s = 0.0;
        const SolvedReadings solved =
            solve_readings(study_, point, blocks_.repetitions, jobs, processor_time_s);
        score_blocks({study_, point, weights[s], candidates_, objective_, blocks_}, solved, first_block, jobs,
                     errors_[s]);
        scenarios_[s] = summarise(errors_[s], candidates_, objective_, blocks_);
    }
}

}  // namespace capstan
