#include "capstan/model_comparison/diagnosis_cost.h"

#include <algorithm>

#include "capstan/gap/cause_search.h"
#include "capstan/platform/clocks.h"

namespace capstan::model_comparison {

namespace {

// A diagnosis in simulations of the pilot, from a dozen recordings of this repository and of the trial. A
// bench with measured numbers is explained by one cause, or sets of causes are tried; a bench whose numbers
// float is always searched for sets.
struct Simulations {
    double min = 0.0;
    double max = 0.0;
};
constexpr Simulations measured_bench{300.0, 3500.0};
constexpr Simulations floating_bench{1200.0, 2500.0};

double simulation_s(const gap::CauseSearch& search, double pilot_s) {
    search.simulate_once();  // the first one fills caches
    const double begin_s = wall_time_s();
    int simulations = 0;
    do {
        search.simulate_once();
        ++simulations;
    } while (wall_time_s() - begin_s < pilot_s);
    return (wall_time_s() - begin_s) / simulations;
}

}  // namespace

DiagnosisCost cost_of_prepared(const Recording& diagnosed, const DiagnosisRequest& request,
                               const gap::DiagnosisOptions& options, double pilot_s) {
    const gap::CauseSearch search(diagnosed, options);
    DiagnosisCost cost;
    cost.runs = static_cast<int>(diagnosed.runs.size());
    for (const RecordedRun& run : diagnosed.runs) cost.samples += run.samples();
    cost.causes = static_cast<int>(search.causes().size());
    cost.simulation_s = simulation_s(search, pilot_s);
    const Simulations& simulations = diagnosed.nominal_is_fitted ? floating_bench : measured_bench;
    const double diagnoses = request.with_simple_models && !request.has_split() ? 3.0 : 1.0;
    cost.min_seconds = diagnoses * simulations.min * cost.simulation_s;
    cost.max_seconds = diagnoses * simulations.max * cost.simulation_s;
    if (options.time_limit_s < cost.max_seconds) {
        cost.max_seconds = options.time_limit_s;
        cost.min_seconds = std::min(cost.min_seconds, cost.max_seconds);
    }
    return cost;
}

DiagnosisCost predict_diagnosis_cost(const Recording& recording, const DiagnosisRequest& request,
                                     const gap::DiagnosisOptions& options, double pilot_s) {
    return cost_of_prepared(prepared_runs(recording, request).diagnosed, request, options, pilot_s);
}

}  // namespace capstan::model_comparison
