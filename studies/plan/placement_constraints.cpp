#include "capstan/plan/placement_constraints.h"

#include <algorithm>

namespace capstan {

namespace {

template <class Value>
bool holds(const std::vector<Value>& values, const Value& value) {
    return std::find(values.begin(), values.end(), value) != values.end();
}

const std::string required_key = "required_nodes";

// In the order in which a clash names them.
const std::vector<std::string> constraint_keys = {required_key,  "forbidden_nodes",    "minimum_spacing",
                                                  "max_sensors", "max_in_distal_half", "budget"};

}  // namespace

std::vector<int> PlacementConstraints::usable_nodes() const {
    std::vector<int> usable;
    for (int node = 0; node < nodes_; ++node) {
        if (!holds(plan_.forbidden_nodes, node)) usable.push_back(node);
    }
    return usable;
}

// Spacing, budget and max_sensors each limit the number of sensors.
int PlacementConstraints::max_sensors() const {
    const std::vector<int> usable = usable_nodes();
    int by_spacing = 0;
    int next_free = 0;
    std::vector<double> costs;
    for (const int node : usable) {
        costs.push_back(node_cost(node));
        if (node < next_free) continue;
        ++by_spacing;
        next_free = node + plan_.minimum_spacing;
    }
    std::sort(costs.begin(), costs.end());
    int by_budget = 0;
    double spent = 0.0;
    for (const double cost : costs) {
        spent += cost;
        if (spent > plan_.budget) break;
        ++by_budget;
    }
    return std::min({by_spacing, by_budget, plan_.max_sensors});
}

double PlacementConstraints::cost(const std::vector<int>& layout) const {
    double sum = 0.0;
    for (const int node : layout) sum += node_cost(node);
    return sum;
}

std::vector<std::string> PlacementConstraints::broken_by(const std::vector<int>& layout) const {
    std::vector<std::string> broken;
    const auto breaks = [&](const std::string& key, bool is_broken) {
        if (is_broken) broken.push_back(key);
    };
    breaks(required_key, std::any_of(plan_.required_nodes.begin(), plan_.required_nodes.end(),
                                     [&](int node) { return !holds(layout, node); }));
    breaks("forbidden_nodes", std::any_of(layout.begin(), layout.end(),
                                          [&](int node) { return holds(plan_.forbidden_nodes, node); }));
    bool near = false;
    for (std::size_t k = 1; k < layout.size(); ++k) {
        near = near || layout[k] - layout[k - 1] < plan_.minimum_spacing;
    }
    breaks("minimum_spacing", near);
    breaks("max_sensors", static_cast<int>(layout.size()) > plan_.max_sensors);
    const auto in_distal_half =
        std::count_if(layout.begin(), layout.end(), [&](int node) { return 2 * node > nodes_ - 1; });
    breaks("max_in_distal_half", in_distal_half > plan_.max_in_distal_half);
    breaks("budget", cost(layout) > plan_.budget);
    return broken;
}

bool PlacementConstraints::allow_on_the_way(const std::vector<int>& layout) const {
    const std::vector<std::string> broken = broken_by(layout);
    return broken.empty() || (broken.size() == 1 && broken.front() == required_key);
}

// Every constraint except the required nodes excludes layouts, and with a layout it excludes every larger
// one. So if any layout satisfies them all, the required nodes alone do, or a single node if none is
// required.
bool PlacementConstraints::satisfiable_with(const std::vector<std::string>& keys) const {
    std::vector<std::vector<int>> smallest;
    if (holds(keys, required_key) && !plan_.required_nodes.empty()) {
        smallest.push_back(plan_.required_nodes);
        std::sort(smallest.back().begin(), smallest.back().end());
    } else {
        for (int node = 0; node < nodes_; ++node) smallest.push_back({node});
    }
    return std::any_of(smallest.begin(), smallest.end(), [&](const std::vector<int>& layout) {
        const std::vector<std::string> broken = broken_by(layout);
        return std::none_of(broken.begin(), broken.end(),
                            [&](const std::string& key) { return holds(keys, key); });
    });
}

std::vector<std::string> PlacementConstraints::clash() const {
    std::vector<std::string> keys = constraint_keys;
    if (satisfiable_with(keys)) return {};
    // A constraint that can be left out while the clash remains is not part of it.
    for (const std::string& key : constraint_keys) {
        std::vector<std::string> others;
        for (const std::string& other : keys) {
            if (other != key) others.push_back(other);
        }
        if (!satisfiable_with(others)) keys = others;
    }
    return keys;
}

}  // namespace capstan
