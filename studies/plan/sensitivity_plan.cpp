#include "capstan/plan/sensitivity_plan.h"

#include <utility>

#include "capstan/estimation/fusion_method.h"

namespace capstan {

std::vector<KeyProblem> problems_of(const SensitivityPlan& plan, int nodes) {
    std::vector<KeyProblem> problems;
    const std::pair<const char*, const std::vector<double>&> ranges[] = {
        {"friction_ratio", plan.friction_ratio},
        {"curvature_ratio", plan.curvature_ratio},
        {"stiffness_ratio", plan.stiffness_ratio},
        {"pretension_ratio", plan.pretension_ratio},
        {"noise_ratio", plan.noise_ratio},
        {"uncertainty_ratio", plan.uncertainty_ratio},
        {"far_end_range_ratio", plan.far_end_range_ratio},
        {"far_end_bandwidth_ratio", plan.far_end_bandwidth_ratio}};
    for (const auto& [key, range] : ranges) {
        if (range.size() == 2 && 0.0 < range[0] && range[0] <= 1.0 && 1.0 <= range[1]) continue;
        problems.push_back(
            {std::string("sensitivity.") + key,
             "give two factors, the smallest (above 0, at most 1) and the largest (at least 1), "
             "as [0.7, 1.4]; [1, 1] means that the value is certain"});
    }
    if (plan.sensors < 1 || plan.sensors > nodes) {
        problems.push_back({"sensitivity.sensors", std::to_string(plan.sensors) + " sensors do not fit on " +
                                                       std::to_string(nodes) + " nodes; use 1 to " +
                                                       std::to_string(nodes)});
    }
    return problems;
}

}  // namespace capstan
