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

/// The designer's constraints and objective. Nodes are counted from 0 here.
struct PlacementPlan {
    PlacementObjective objective = PlacementObjective::all_nodes;
    std::vector<int> forbidden_nodes{};
    std::vector<int> required_nodes{};
    int minimum_spacing = 1;  ///< segments between neighbouring sensors
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
