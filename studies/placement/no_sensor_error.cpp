#include "capstan/placement/no_sensor_error.h"

#include <cmath>

#include "capstan/placement/prepared_study.h"

namespace capstan {

std::map<std::string, double> no_sensor_errors_N(const StudyPlan& plan) {
    const PreparedStudy study = prepare(plan);
    std::map<Regime, double> sums_N;
    std::map<Regime, int> instants;
    for (const PreparedScenario& scenario : study.scenarios) {
        std::vector<double> certainty(static_cast<std::size_t>(scenario.curve.points()), 0.0);
        std::vector<double> mean_N(scenario.truth.tension_N.size());
        posterior_mean(scenario.curve, certainty, mean_N);
        for (std::size_t node = 0; node < mean_N.size(); ++node)
            sums_N[scenario.regime] +=
                std::abs(mean_N[node] - scenario.truth.tension_N[node]) / static_cast<double>(mean_N.size());
        ++instants[scenario.regime];
    }
    std::map<std::string, double> errors_N;
    for (const RegimeInstants& regime : plan.regimes) {
        const double error_N = sums_N[regime.regime] / instants[regime.regime];
        errors_N[std::string(name_of(regime.regime))] = error_N;
        errors_N["duty_cycle"] += regime.duty_fraction * error_N;
    }
    return errors_N;
}

}  // namespace capstan
