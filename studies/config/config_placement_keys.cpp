#include "capstan/config/config_key_makers.h"
#include "capstan/config/config_study_keys.h"

namespace capstan::config {

namespace {

using StudyKey = ConfigKey<StudyPlan>;

// A configuration counts nodes from 1, the plan from 0.
StudyKey node_list(KeyText about, std::vector<int> PlacementPlan::*field) {
    StudyKey key{about.section, about.name, {ValueKind::integers, about.unit, {1, true, 10001}}};
    key.help = std::move(about.help);
    key.default_value = std::vector<std::int64_t>{};
    key.read = [field](const StudyPlan& plan, int) -> ConfigValue {
        std::vector<std::int64_t> nodes;
        for (const int node : plan.placement.*field) nodes.push_back(node + 1);
        return nodes;
    };
    key.write = [field](StudyPlan& plan, int, const ConfigValue& value) {
        (plan.placement.*field).clear();
        for (const auto node : std::get<std::vector<std::int64_t>>(value)) {
            (plan.placement.*field).push_back(static_cast<int>(node) - 1);
        }
    };
    return key;
}

}  // namespace

void add_placement_keys(std::vector<ConfigKey<StudyPlan>>& keys) {
    const std::string at = "placement";
    std::vector<Named<PlacementObjective>> objectives;
    for (const PlacementObjective objective : all_placement_objectives) {
        objectives.push_back({std::string(name_of(objective)), objective});
    }
    keys.push_back(choice<PlacementObjective>(
        {at, "objective", "",
         "The error to minimise: its mean over \"all_nodes\" (with [uncertainty] over the cable's length), at the \"load_end\", at the "
         "\"worst_node\", or its \"quantile_95\", which 95 % of the draws stay below."},
        objectives, std::string("all_nodes"),
        [](auto& plan, int) -> auto& { return plan.placement.objective; }));
    keys.push_back(node_list({at, "forbidden_nodes", "", "Nodes where no sensor fits, counted from 1."},
                             &PlacementPlan::forbidden_nodes));
    keys.push_back(node_list({at, "required_nodes", "", "Nodes that must carry a sensor."},
                             &PlacementPlan::required_nodes));
    keys.push_back(integer(
        {at, "minimum_spacing", "",
         "Minimum number of segments between neighbouring sensors; 1 allows all layouts."},
        {1, true, 10000}, std::int64_t{PlacementPlan{}.minimum_spacing},
        [](auto& plan, int) -> auto& { return plan.placement.minimum_spacing; }));
    keys.push_back(integer(
        {at, "max_sensors", "", "Maximum number of sensors; a long cable needs a limit for an exact search."},
        {1, true, 64}, std::int64_t{PlacementPlan{}.max_sensors},
        [](auto& plan, int) -> auto& { return plan.placement.max_sensors; }));
    keys.push_back(integer(
        {at, "max_in_distal_half", "",
         "Maximum number of sensors beyond the middle of the cable, on the side of the load and the "
         "wearer."},
        {0, true, 64}, std::int64_t{PlacementPlan{}.max_in_distal_half},
        [](auto& plan, int) -> auto& { return plan.placement.max_in_distal_half; }));
    StudyKey costs = number_list<StudyPlan>(
        {at, "node_costs", "", "Cost of a sensor at each node, proximal end first; empty: 1 everywhere."},
        zero_or_more, {}, [](auto& plan, int) -> auto& { return plan.placement.node_costs; });
    costs.allowed.may_be_empty = true;
    keys.push_back(std::move(costs));
    keys.push_back(number(
        {at, "budget", "", "Maximum total cost of all sensors, in the unit of node_costs."}, zero_or_more,
        PlacementPlan{}.budget, [](auto& plan, int) -> auto& { return plan.placement.budget; }));
    keys.push_back(number(
        {at, "largest_error_after_loss_N", "N", "Maximum error after the failure of any one sensor."},
        above_zero, PlacementPlan{}.largest_error_after_loss_N,
        [](auto& plan, int) -> auto& { return plan.placement.largest_error_after_loss_N; }));
}

}  // namespace capstan::config
