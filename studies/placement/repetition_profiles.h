#pragma once

#include <cstdint>
#include <vector>

#include "capstan/placement/prepared_study.h"
#include "capstan/placement/single_sensor_stage.h"

namespace capstan {

/// The single-sensor estimates of one repetition as fusion methods read them, one per node as if every node
/// had a sensor.
class RepetitionProfiles {
  public:
    /// `scenario` must outlive it.
    RepetitionProfiles(const PreparedScenario& scenario, int nodes);

    void fill(const SolvedReadings& solved, int repetition);

    SensorEstimates unknown() const { return {nodes_, unknown_N_, directions_, verified_}; }
    SensorEstimates known() const { return {nodes_, known_N_, {}, known_usable_}; }

  private:
    void write_profile(const SensorBranch& branch, double reading_N, std::vector<double>& all_N, int sensor);

    const PreparedScenario& scenario_;
    int nodes_;
    std::vector<double> unknown_N_;  // sensors x padded nodes
    std::vector<double> known_N_;    // sensors x padded nodes
    std::vector<DirectionBits> directions_;
    std::vector<std::uint8_t> verified_;
    std::vector<std::uint8_t> known_usable_;
};

}  // namespace capstan
