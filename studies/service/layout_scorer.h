#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "capstan/placement/intervals.h"
#include "capstan/placement/prepared_study.h"
#include "capstan/placement/single_sensor_stage.h"
#include "capstan/plan/study_plan.h"

namespace capstan::service {

/// Sensors and how their readings are fused.
struct PlacedLayout {
    std::vector<int> nodes;  ///< from 1, any order
    std::string method;      ///< of fusion_methods()
};

/// Sensors placed by hand.
struct LayoutQuestion {
    PlacedLayout layout;
    std::string regime;   ///< name_of(Regime), or "duty_cycle": all, as the plan weighs them
    int noise_index = 0;  ///< of the study's noise levels
    std::optional<PlacedLayout> reference;  ///< to compare with, on the same draws
};

struct NodeError {
    int node = 0;  ///< from 1
    double mean_abs_error_N = 0.0;
    double bias_N = 0.0;
    double low_N = 0.0;  ///< absolute errors of 90% of the draws are between these
    double high_N = 0.0;
};

/// The expected error of a layout, over the instants of a regime or over the duty cycle.
struct LayoutScore {
    Score error;            ///< mean over the nodes, by block of repetitions
    IntervalEstimate mean;  ///< 95%, Student's t on the block means, as of a recommendation
    int repetitions = 0;
    int instants = 0;
    std::vector<NodeError> nodes;  // nodes
};

struct LayoutComparison {
    LayoutScore placed;
    std::optional<LayoutScore> reference;
    IntervalEstimate difference;  ///< placed - reference, 95%, paired
};

/// Scores any set of sensors as a study scores its layouts: with the study's instants, draws and weights, so
/// that a layout of the study gets the study's numbers. Readings are solved once and kept. For any thread.
class LayoutScorer {
  public:
    /// Throws InvalidInput if the plan cannot run. Of a study's repetitions the first 2000 are used.
    explicit LayoutScorer(StudyPlan plan);

    /// Throws InvalidInput with every problem of the question.
    LayoutComparison score(const LayoutQuestion& question);

  private:
    struct Solved {
        SolvedReadings readings;
        std::vector<double> sensor_error_N;  // nodes
    };

    void check(const LayoutQuestion& question) const;
    std::vector<double> scenario_weights(const std::string& regime) const;
    LayoutScore score_of(const PlacedLayout& layout, const std::vector<double>& scenario_weights, int noise);
    const Solved& solved(int scenario, int noise);
    std::vector<double> weights(int scenario, int noise);

    StudyPlan plan_;
    PreparedStudy study_;
    std::mutex mutex_;
    std::map<std::pair<int, int>, Solved> kept_;  // by scenario and noise index
};

}  // namespace capstan::service
