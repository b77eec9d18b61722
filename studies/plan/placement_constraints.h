#pragma once

#include <string>
#include <vector>

#include "capstan/plan/placement_plan.h"

namespace capstan {

/// The constraints that a layout alone decides; the error after a loss needs scores.
class PlacementConstraints {
  public:
    /// `plan` must outlive it.
    PlacementConstraints(const PlacementPlan& plan, int nodes) : plan_(plan), nodes_(nodes) {}

    /// Nodes that are not forbidden, from 0, rising.
    std::vector<int> usable_nodes() const;
    /// No layout with more sensors can satisfy them.
    int max_sensors() const;
    /// Sum of the nodes' costs.
    double cost(const std::vector<int>& layout) const;
    /// The keys of the constraints that a layout (nodes from 0, rising) breaks; none: it is allowed.
    std::vector<std::string> broken_by(const std::vector<int>& layout) const;
    bool allow(const std::vector<int>& layout) const { return broken_by(layout).empty(); }
    /// As allow(), for a layout that may still grow: required nodes may be missing.
    bool allow_on_the_way(const std::vector<int>& layout) const;
    /// A smallest group of constraints, by key, that no layout satisfies together; empty: there is a layout.
    std::vector<std::string> clash() const;

  private:
    double node_cost(int node) const { return plan_.node_costs.empty() ? 1.0 : plan_.node_costs[node]; }
    bool satisfiable_with(const std::vector<std::string>& keys) const;

    const PlacementPlan& plan_;
    int nodes_;
};

}  // namespace capstan
