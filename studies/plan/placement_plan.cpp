#include "capstan/plan/placement_plan.h"

#include <algorithm>
#include <cmath>

#include "capstan/plan/placement_constraints.h"
#include "capstan/sensing/layout.h"

namespace capstan {

namespace {

using Problems = std::vector<KeyProblem>;

void check_nodes(const std::string& key, const std::vector<int>& named, int nodes, Problems& problems) {
    for (const int node : named) {
        if (node >= 0 && node < nodes) continue;
        problems.push_back({"placement." + key, "node " + std::to_string(node + 1) +
                                                    " is outside the cable, whose nodes are 1 to " +
                                                    std::to_string(nodes)});
    }
}

void check_costs(const PlacementPlan& plan, int nodes, Problems& problems) {
    const int given = static_cast<int>(plan.node_costs.size());
    if (given != 0 && given != nodes) {
        problems.push_back({"placement.node_costs",
                            "there are " + std::to_string(given) + " costs for " + std::to_string(nodes) +
                                " nodes; give one for each, proximal end first, or none"});
    }
    for (const double cost : plan.node_costs) {
        if (std::isfinite(cost) && cost >= 0.0) continue;
        problems.push_back({"placement.node_costs", "a cost must be 0 or more"});
        return;
    }
}

// What a constraint of a clash asks for, for the message.
std::string said_by(const std::string& key, const PlacementPlan& plan) {
    char number[32];
    if (key == "required_nodes") return key + " = [" + nodes_as_people_count(plan.required_nodes) + "]";
    if (key == "forbidden_nodes") return key + " = [" + nodes_as_people_count(plan.forbidden_nodes) + "]";
    if (key == "minimum_spacing") return key + " = " + std::to_string(plan.minimum_spacing);
    if (key == "max_sensors") return key + " = " + std::to_string(plan.max_sensors);
    if (key == "max_in_distal_half") return key + " = " + std::to_string(plan.max_in_distal_half);
    std::snprintf(number, sizeof number, "%g", plan.budget);
    return key + " = " + number;
}

}  // namespace

std::string_view name_of(PlacementObjective objective) {
    switch (objective) {
        case PlacementObjective::all_nodes:
            return "all_nodes";
        case PlacementObjective::load_end:
            return "load_end";
        case PlacementObjective::worst_node:
            return "worst_node";
        case PlacementObjective::quantile_95:
            return "quantile_95";
    }
    return {};
}

std::vector<KeyProblem> problems_of(const PlacementPlan& plan, int nodes) {
    Problems problems;
    check_nodes("forbidden_nodes", plan.forbidden_nodes, nodes, problems);
    check_nodes("required_nodes", plan.required_nodes, nodes, problems);
    check_costs(plan, nodes, problems);
    if (!problems.empty()) return problems;
    const std::vector<std::string> clash = PlacementConstraints(plan, nodes).clash();
    if (clash.empty()) return problems;
    std::string together;
    for (const std::string& key : clash) together += (together.empty() ? "" : ", ") + said_by(key, plan);
    problems.push_back({"placement." + clash.front(),
                        "no layout satisfies " + together +
                            (clash.size() > 1 ? " together; loosen one of them" : "; loosen it")});
    return problems;
}

}  // namespace capstan
