#pragma once

#include <vector>

#include "capstan/model_comparison/model_comparison.h"

namespace capstan::model_comparison {

/// Which runs of a recording are diagnosed, by their numbers, and what is compared. A list without a number
/// is one that was not given.
struct DiagnosisRequest {
    std::vector<int> runs;            ///< only these are diagnosed; not together with `fit` and `hold`
    std::vector<int> calibrate_on;    ///< to which a drive of unknown geometry is calibrated
    std::vector<int> fit;             ///< diagnosed; without it all that are not held out
    std::vector<int> hold;            ///< held out; without it all that are not fitted, where `fit` is there
    bool with_simple_models = false;  ///< the errors of the simple models stand beside those of the bench

    bool has_split() const { return !fit.empty() || !hold.empty(); }
};

/// A diagnosis, what its corrected model leaves, and how that model does on runs that it did not see.
struct DiagnosedRuns {
    DiagnosedSplit split;             ///< all diagnosed runs are fitted where none is held out
    std::vector<LeftOver> left_over;  ///< of the runs that were diagnosed
    ModelComparison comparison;       ///< empty where nothing is held out and nothing compared
};

/// The runs that diagnose_runs fits, as the equivalent bench where the geometry is unknown. Throws as it
/// does.
Recording runs_to_diagnose(const Recording& recording, const DiagnosisRequest& request);

/// Diagnoses the runs that are asked for, of all runs if none are. Without a split, a comparison with simple
/// models diagnoses two halves of the runs as well; progress counts all of it. Throws InvalidInput where a
/// run does not exist, is both fitted and held out, or where none is left to fit.
DiagnosedRuns diagnose_runs(const Recording& recording, const DiagnosisRequest& request,
                            const gap::DiagnosisOptions& options);

}  // namespace capstan::model_comparison
