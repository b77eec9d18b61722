#pragma once

#include <span>
#include <vector>

#include "capstan/placement/prepared_study.h"
#include "capstan/placement/single_sensor_stage.h"
#include "capstan/storage/records.h"

namespace capstan {

/// Processor time [s] of the fusion stage by what it went to.
struct FusionTimes {
    double paper_methods_s = 0.0;
    double feasible_curve_s = 0.0;
    double statistics_s = 0.0;
};

/// Fuses every sensor set with every method in every repetition and sums up each cell. `weight` is one
/// positive number per node, any scale.
storage::FusionResult fuse_readings(const PreparedStudy& study, const StudyPoint& point,
                                    const SolvedReadings& solved, std::span<const double> weight, int jobs,
                                    FusionTimes& times);

/// The estimates of one repetition, in the order of the study's sensor sets, then of its methods.
std::vector<std::vector<double>> fuse_repetition(const PreparedStudy& study, const StudyPoint& point,
                                                 const SolvedReadings& solved, std::span<const double> weight,
                                                 int repetition);

}  // namespace capstan
