#pragma once

#include "capstan/model_comparison/diagnosed_runs.h"

namespace capstan::model_comparison {

/// How long a diagnosis takes on this machine. What is found decides how many causes are fitted: one that is
/// explained by a single cause ends early.
struct DiagnosisCost {
    int runs = 0;               ///< that are fitted
    int samples = 0;            ///< of these runs
    int causes = 0;             ///< that are screened
    double simulation_s = 0.0;  ///< simulating these runs once, as the search does most often, by one thread
    double min_seconds = 0.0;   ///< where the search ends early
    double max_seconds = 0.0;   ///< where sets of causes are tried
};

/// Of the runs that diagnose_runs fits, as the equivalent bench where the geometry is unknown. Simulates them
/// for about `pilot_s`, and at least twice.
DiagnosisCost cost_of_prepared(const Recording& diagnosed, const DiagnosisRequest& request,
                               const gap::DiagnosisOptions& options, double pilot_s);

/// Prepares the runs for that. Throws as diagnose_runs does.
DiagnosisCost predict_diagnosis_cost(const Recording& recording, const DiagnosisRequest& request,
                                     const gap::DiagnosisOptions& options, double pilot_s = 0.5);

}  // namespace capstan::model_comparison
