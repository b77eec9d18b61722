#include <numeric>

#include "capstan/config/config_key_makers.h"
#include "capstan/config/config_study_keys.h"
#include "capstan/estimation/fusion_method.h"

namespace capstan::config {

namespace {

using StudyKey = ConfigKey<StudyPlan>;

template <class Entry>
std::vector<std::string> names_of(const std::vector<Entry>& catalogue) {
    std::vector<std::string> names;
    for (const Entry& entry : catalogue) names.emplace_back(entry.name);
    return names;
}

// A list of names out of a catalogue, or "all".
StudyKey name_list(KeyText about, const std::vector<std::string>& catalogue,
                   std::vector<std::string> StudyPlan::*field) {
    StudyKey key{about.section, about.name, {ValueKind::names, about.unit}};
    key.help = std::move(about.help);
    key.allowed.names = catalogue;
    key.allowed.takes_all = true;
    key.default_value = std::string("all");
    key.read = [field](const StudyPlan& plan, int) -> ConfigValue { return plan.*field; };
    key.write = [field, catalogue](StudyPlan& plan, int, const ConfigValue& value) {
        const auto* given = std::get_if<std::vector<std::string>>(&value);
        plan.*field = given ? *given : catalogue;
    };
    return key;
}

StudyKey sensor_counts() {
    StudyKey key{"layouts", "counts", {ValueKind::integers, "", {1, true, 10001}}};
    key.help = "Numbers of sensors to try with each family; \"all\" means from 1 to one at every node.";
    key.allowed.takes_all = true;
    key.default_value = std::string("all");
    key.read = [](const StudyPlan& plan, int) -> ConfigValue {
        return std::vector<std::int64_t>(plan.sensor_counts.begin(), plan.sensor_counts.end());
    };
    key.write = [](StudyPlan& plan, int, const ConfigValue& value) {
        if (const auto* given = std::get_if<std::vector<std::int64_t>>(&value)) {
            plan.sensor_counts.assign(given->begin(), given->end());
        } else {
            plan.sensor_counts.resize(plan.transmission.cable.segments + 1);
            std::iota(plan.sensor_counts.begin(), plan.sensor_counts.end(), 1);
        }
    };
    return key;
}

// A configuration counts nodes from 1, the plan from 0.
StudyKey explicit_layouts() {
    StudyKey key{"layouts", "explicit", {ValueKind::node_sets, "", {1, true, 10001}}};
    key.help = "Further layouts as lists of nodes, counted from 1 at the proximal end: [[1, 6, 11], [3, 9]].";
    key.default_value = std::vector<std::vector<std::int64_t>>{};
    key.read = [](const StudyPlan& plan, int) -> ConfigValue {
        std::vector<std::vector<std::int64_t>> sets;
        for (const auto& nodes : plan.explicit_layouts) {
            sets.emplace_back();
            for (const int node : nodes) sets.back().push_back(node + 1);
        }
        return sets;
    };
    key.write = [](StudyPlan& plan, int, const ConfigValue& value) {
        plan.explicit_layouts.clear();
        for (const auto& set : std::get<std::vector<std::vector<std::int64_t>>>(value)) {
            plan.explicit_layouts.emplace_back();
            for (const auto node : set) plan.explicit_layouts.back().push_back(static_cast<int>(node) - 1);
        }
    };
    return key;
}

}  // namespace

void add_layout_keys(std::vector<ConfigKey<StudyPlan>>& keys) {
    std::string help = "Families of layouts, each a rule that places the sensors:";
    for (const LayoutFamily& family : layout_families()) {
        help += " \"" + std::string(family.name) + "\" " + std::string(family.meaning) + ";";
    }
    help.back() = '.';
    keys.push_back(name_list({"layouts", "families", "", help}, names_of(layout_families()),
                             &StudyPlan::layout_families));
    keys.push_back(sensor_counts());
    keys.push_back(explicit_layouts());
}

void add_estimation_keys(std::vector<ConfigKey<StudyPlan>>& keys) {
    const std::string at = "estimation";
    std::string help = "Methods that fuse several sensors:";
    for (const FusionMethod& method : fusion_methods()) {
        help += " \"" + std::string(method.name) + "\" (" + std::string(method.title) + ") " +
                std::string(method.meaning) + ";";
    }
    help.back() = '.';
    keys.push_back(
        name_list({at, "methods", "", help}, names_of(fusion_methods()), &StudyPlan::fusion_methods));
    keys.push_back(choice<DistalSide>(
        {at, "distal_side", "",
         "Whether an estimate from one sensor may contain nodes that the distal end has set in "
         "motion. \"excluded\" fits a blocked output, as in the paper; \"admitted\" fits an output "
         "that moves."},
        {{"excluded", DistalSide::excluded}, {"admitted", DistalSide::admitted}}, std::string("excluded"),
        [](auto& plan, int) -> auto& { return plan.distal_side; }));
    keys.push_back(choice<WeightSource>(
        {at, "weights", "",
         "Source of the weights of the W methods: the single-sensor errors in \"mass_motion\" for "
         "every regime, as in the paper (requires that regime), or those of the \"same_regime\"."},
        {{"mass_motion", WeightSource::mass_motion}, {"same_regime", WeightSource::same_regime}},
        std::string("mass_motion"), [](auto& plan, int) -> auto& { return plan.weight_source; }));
    keys.push_back(number(
        {at, "largest_distal_increment_m", "m",
         "Largest movement of the distal end in one sample, in either direction: the flat prior of "
         "the feasible-curve methods. 0.00063 m is the largest step of a 1 cm amplitude at 1 Hz and "
         "100 samples per second."},
        above_zero, 0.00063, [](auto& plan, int) -> auto& { return plan.largest_distal_increment_m; }));
    keys.push_back(integer(
        {at, "curve_points", "",
         "Number of points on the curve of feasible states; a multiple of 8. The grid adds an error "
         "inversely proportional to their number: below 0.01 N with 128 points for the paper's cable. "
         "Use more points for sensors with an error of this size."},
        {8, true, 100000}, std::int64_t{default_curve_points},
        [](auto& plan, int) -> auto& { return plan.curve_points; }));
}

}  // namespace capstan::config
