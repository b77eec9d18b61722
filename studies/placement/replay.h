#pragma once

#include <vector>

#include "capstan/plan/study_plan.h"

namespace capstan {

/// Which repetition to look at.
struct ReplayAddress {
    int scenario_index = 0;
    int noise_index = 0;
    int repetition = 0;
};

/// One repetition alone, as it ran in the study: the same readings, the same estimates.
struct ReplayedEstimate {
    std::string layout;      ///< label
    std::vector<int> nodes;  // sensors, from 0
    std::string method;
    std::vector<double> tension_N;  // nodes
    double mean_abs_error_N = 0.0;
};

struct ReplayedSensor {
    int node = 0;
    double reading_N = 0.0;
    int verifying_patterns = 0;
    std::string directions;         ///< one of + 0 - per segment
    std::vector<double> tension_N;  // nodes
};

struct Replay {
    std::vector<double> true_tension_N;  // nodes
    std::vector<ReplayedSensor> sensors;
    std::vector<ReplayedEstimate> estimates;
};

/// On up to `jobs` threads (0: all processors). Throws InvalidInput if the address is outside the plan.
Replay replay(const StudyPlan& plan, const ReplayAddress& address, int jobs);

}  // namespace capstan
