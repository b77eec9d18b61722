#pragma once

#include <cstdint>
#include <vector>

#include "capstan/placement/prepared_study.h"
#include "capstan/storage/records.h"

namespace capstan {

/// Every reading of one scenario and noise level, solved once; all layouts, counts and methods are served
/// from it.
struct SolvedReadings {
    int nodes = 0;
    std::vector<double> reading_N;        // repetitions x nodes
    std::vector<std::uint16_t> branch;    // repetitions x nodes: SingleSensorEstimator::Choice::branch
    std::vector<std::uint8_t> verifying;  // repetitions x nodes: patterns that verify, 255 for more

    std::size_t at(int repetition, int node) const {
        return static_cast<std::size_t>(repetition) * nodes + node;
    }
};

/// Which scenario and noise level of a study.
struct StudyPoint {
    int scenario_index = 0;
    int noise_index = 0;
    std::uint32_t first_draw = 0;  ///< random address of repetition 0; a study's own is 0
};

/// First address of the independent draws, which no study uses: its repetitions are numbered below 2^31. A
/// choice that was made on a study's own draws is judged on these.
inline constexpr std::uint32_t independent_draws = std::uint32_t{1} << 31;

/// Draws, reads and solves repetitions first to end - 1 into their slots.
void solve_block(const PreparedStudy& study, const StudyPoint& point, int first, int end,
                 SolvedReadings& solved);

/// Repetitions 0 to `repetitions` - 1. Adds the processor time used to `processor_time_s`.
SolvedReadings solve_readings(const PreparedStudy& study, const StudyPoint& point, int repetitions, int jobs,
                              double& processor_time_s);
/// All repetitions of the study.
SolvedReadings solve_readings(const PreparedStudy& study, const StudyPoint& point, int jobs,
                              double& processor_time_s);

/// The readings alone of all repetitions, none solved: enough for methods on the feasible curve.
SolvedReadings only_readings(const PreparedStudy& study, const StudyPoint& point);

/// Single-sensor errors and profiles (the paper's e_ij and its Fig. 8), direction known and unknown.
storage::SingleSensorResult summarise_sensors(const PreparedStudy& study, const StudyPoint& point,
                                              const SolvedReadings& solved, int jobs);

/// Mean absolute error [N] of each sensor's estimate, direction unknown.
std::vector<double> sensor_errors_N(const storage::SingleSensorResult& result);  // nodes

/// Whether the errors of one scenario are a source of the weights of another.
bool gives_weights(const PreparedStudy& study, int source_index, int fused_index);

/// Weights of the W methods for one scenario: 1 / (mean single-sensor error), the mean taken over the
/// scenarios that the plan names as source. `errors_N` is scenarios x nodes; only the
/// sources are read.
std::vector<double> sensor_weights(const PreparedStudy& study,
                                   const std::vector<std::vector<double>>& errors_N, int scenario_index);

}  // namespace capstan
