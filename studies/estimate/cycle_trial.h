#pragma once

#include <string>
#include <vector>

#include "capstan/plan/study_plan.h"
#include "capstan/sensing/layout.h"

namespace capstan::estimate {

struct CycleOptions {
    int members = 32;
    int repetitions = 20;
    int jobs = 1;
};

/// One layout, scored over a complete motion: every sample from the second on, every node, every repetition.
struct CycleScore {
    Layout layout;
    double wander_m = 0.0;        ///< of the distal end in a sample; the most likely of a few on other draws
    double error_N = 0.0;         ///< mean size of the recursive estimator's error
    double coverage = 0.0;        ///< fraction of tensions within its 95% band
    double band_N = 0.0;          ///< mean half width of that band
    double paper_mean_N = 0.0;    ///< mean size of the error of the paper's Mean from its own estimates
    double paper_mean_r_N = 0.0;  ///< of its Mean-R
};

/// Simulates the plan's motion once, draws readings at its first noise level, and runs the recursive
/// estimator and the paper's estimators over them, each started from its own last estimate, for every layout
/// of the plan's families and counts. All know the model, the start and `u_1`, none the distal end. The
/// wander is chosen by evidence (E38) on draws that nothing is scored with.
std::vector<CycleScore> score_cycles(const StudyPlan& plan, const CycleOptions& options);

}  // namespace capstan::estimate
