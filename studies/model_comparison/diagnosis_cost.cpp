#include "capstan/model_comparison/diagnosis_cost.h"

#include <algorithm>
#include <thread>

#include "capstan/gap/cause_search.h"
#include "capstan/platform/clocks.h"

namespace capstan::model_comparison {

namespace {

// A diagnosis in simulations of the pilot, from two dozen recordings of this repository, of the trial and of
// real drives. A bench with measured numbers is explained by one cause, or sets of causes are tried; a bench
// whose numbers float is always searched for sets, from every start where no cause is clear. Two threads take
// half of that time, and a tenth more.
struct Simulations {
    double min = 0.0;
    double max = 0.0;
};
constexpr Simulations measured_bench{600.0, 9000.0};
constexpr Simulations floating_bench{8000.0, 90000.0};

int threads_of(const gap::DiagnosisOptions& options) {
    return std::max(
        1, options.threads > 0 ? options.threads : static_cast<int>(std::thread::hardware_concurrency()));
}

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
    const double unit_s = diagnoses * cost.simulation_s / threads_of(options);
    cost.min_seconds = simulations.min * unit_s;
    cost.max_seconds = simulations.max * unit_s;
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
