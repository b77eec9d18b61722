#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "capstan/cable/invalid_input.h"

namespace capstan {

/// The error by which a layout is judged.
enum class PlacementObjective {
    all_nodes,    ///< mean over all nodes
    load_end,     ///< at the distal node
    worst_node,   ///< at the node where the mean over repetitions is largest
    quantile_95,  ///< 95% quantile over repetitions of the mean over all nodes
};

std::string_view name_of(PlacementObjective objective);
inline constexpr PlacementObjective all_placement_objectives[] = {
    PlacementObjective::all_nodes, PlacementObjective::load_end, PlacementObjective::worst_node,
    PlacementObjective::quantile_95};

/// Which sets of sensors are compared.
enum class ComparedSets {
    named,   ///< those of [layouts], with and without the sensors of other kinds
    all,     ///< every set that the constraints allow; of too many, as greedy
    greedy,  ///< the named ones, and sets that grow by the sensor that helps most
};

/// The designer's constraints and objective. Nodes are counted from 0 here.
struct PlacementPlan {
    PlacementObjective objective = PlacementObjective::all_nodes;
    std::vector<int> forbidden_nodes{};
    std::vector<int> required_nodes{};
    // Of studies with uncertainty, along the cable from the motor.
    ComparedSets search = ComparedSets::named;
    std::vector<double> forbidden_m{};  ///< pairs: from, to
    std::vector<double> required_m{};
    double minimum_spacing_m = 0.0;
    double resolution_N = 0.01;   ///< differences in error below this are not followed up
    double target_error_N = 0.0;  ///< the cheapest set below it is named; 0: none
    int minimum_spacing = 1;      ///< segments between neighbouring sensors
    int max_sensors = 64;
    int max_in_distal_half = 64;       ///< sensors beyond the middle of the cable
    std::vector<double> node_costs{};  // nodes; empty: each sensor costs 1
    double budget = 1e9;               ///< in the unit of node_costs
    /// Largest allowed error after the worst loss of one sensor [N].
    double largest_error_after_loss_N = 1e9;
};

/// Everything that is wrong with the plan on a cable of `nodes` nodes. Where no layout satisfies all
/// constraints, the message names a smallest group of them that clash.
std::vector<KeyProblem> problems_of(const PlacementPlan& plan, int nodes);

}  // namespace capstan
