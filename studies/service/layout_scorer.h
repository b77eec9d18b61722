#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "capstan/placement/prepared_study.h"
#include "capstan/placement/single_sensor_stage.h"
#include "capstan/plan/study_plan.h"

namespace capstan::service {

/// Sensors placed by hand.
struct LayoutQuestion {
    std::vector<int> nodes;  ///< from 1, any order
    std::string method;      ///< of fusion_methods()
    std::string regime;      ///< name_of(Regime)
    int noise_index = 0;     ///< of the study's noise levels
};

struct NodeError {
    int node = 0;  ///< from 1
    double mean_abs_error_N = 0.0;
    double bias_N = 0.0;
};

/// Their expected error, over the regime's instants.
struct LayoutScore {
    double mean_abs_error_N = 0.0;
    double interval_low_N = 0.0;  ///< 95%, over draws
    double interval_high_N = 0.0;
    int repetitions = 0;
    int instants = 0;
    std::vector<NodeError> nodes;  // nodes
};

/// Scores any set of sensors as a study scores its layouts: with the study's instants, draws and weights, so
/// that a layout of the study gets the study's numbers. Readings are solved once and kept. For any thread.
class LayoutScorer {
  public:
    /// Throws InvalidInput if the plan cannot run. Of a study's repetitions the first 2000 are used.
    explicit LayoutScorer(StudyPlan plan);

    /// Throws InvalidInput with every problem of the question.
    LayoutScore score(const LayoutQuestion& question);

  private:
    struct Solved {
        SolvedReadings readings;
        std::vector<double> sensor_error_N;  // nodes
    };

    void check(const LayoutQuestion& question) const;
    const Solved& solved(int scenario, int noise);
    std::vector<double> weights(int scenario, int noise);

    StudyPlan plan_;
    PreparedStudy study_;
    std::mutex mutex_;
    std::map<std::pair<int, int>, Solved> kept_;  // by scenario and noise index
};

}  // namespace capstan::service
