#pragma once

#include <functional>
#include <vector>

#include "capstan/model_comparison/model_comparison.h"

namespace capstan::model_comparison {

/// Which runs of a recording are diagnosed, by their numbers, and what is compared. A list without a number
/// is one that was not given.
struct DiagnosisRequest {
    std::vector<int> runs{};          ///< only these are diagnosed; not together with `fit` and `hold`
    std::vector<int> calibrate_on{};  ///< to which a drive of unknown geometry is calibrated
    std::vector<int> fit{};           ///< diagnosed; without it all that are not held out
    std::vector<int> hold{};          ///< held out; without it all that are not fitted, where `fit` is there
    bool with_simple_models = false;  ///< the errors of the simple models stand beside those of the bench

    bool has_split() const { return !fit.empty() || !hold.empty(); }
};

/// A diagnosis, what its corrected model leaves, and how that model does on runs that it did not see.
struct DiagnosedRuns {
    DiagnosedSplit split;             ///< all diagnosed runs are fitted where none is held out
    std::vector<LeftOver> left_over;  ///< of the runs that were diagnosed
    ModelComparison comparison;       ///< empty where nothing is held out and nothing compared
};

/// The runs that diagnose_runs fits, not diagnosed yet. Throws as it does.
DiagnosedSplit prepared_runs(const Recording& recording, const DiagnosisRequest& request);

struct DiagnosisCost;

/// Diagnoses the runs that are asked for, of all runs if none are. Without a split, a comparison with simple
/// models diagnoses two halves of the runs as well; progress counts all of it. `on_cost` is
/// told how long all of it takes, once, before the first search. Throws InvalidInput where a
/// run does not exist, is both fitted and held out, or where none is left to fit.
DiagnosedRuns diagnose_runs(const Recording& recording, const DiagnosisRequest& request,
                            const gap::DiagnosisOptions& options,
                            const std::function<void(const DiagnosisCost&)>& on_cost = {});

}  // namespace capstan::model_comparison
