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
    key.help = "Numbers of sensors tried with each family; \"all\" is 1 up to one at every node.";
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

// People count nodes from 1, the plan from 0.
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
    std::string help = "Rules that place sensors:";
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
    std::string help = "Ways to fuse several sensors:";
    for (const FusionMethod& method : fusion_methods()) {
        help += " \"" + std::string(method.name) + "\" (" + std::string(method.title) + ") " +
                std::string(method.meaning) + ";";
    }
    help.back() = '.';
    keys.push_back(
        name_list({at, "methods", "", help}, names_of(fusion_methods()), &StudyPlan::fusion_methods));
    keys.push_back(choice<DistalSide>(
        {at, "distal_side", "",
         "Whether an estimate from one sensor may let the distal end set nodes of its own in motion. \"excluded\" fits "
         "a blocked output, as in the paper; \"admitted\" fits an output that moves."},
        {{"excluded", DistalSide::excluded}, {"admitted", DistalSide::admitted}}, std::string("excluded"),
        [](auto& plan, int) -> auto& { return plan.distal_side; }));
    keys.push_back(choice<WeightSource>(
        {at, "weights", "",
         "Where the W methods take their weights from: the single-sensor errors in \"mass_motion\" whatever the "
         "regime, as the paper does (needs that regime), or those of the \"same_regime\"."},
        {{"mass_motion", WeightSource::mass_motion}, {"same_regime", WeightSource::same_regime}},
        std::string("mass_motion"), [](auto& plan, int) -> auto& { return plan.weight_source; }));
    keys.push_back(number(
        {at, "largest_distal_increment_m", "m",
         "How far the distal end may have moved in one sample, either way: the flat prior of the "
         "feasible-curve methods. 0.00063 m is the largest step of a 1 cm amplitude at 1 Hz and 100 "
         "samples per second."},
        above_zero, 0.00063, [](auto& plan, int) -> auto& { return plan.largest_distal_increment_m; }));
    keys.push_back(integer(
        {at, "curve_points", "",
         "Points along the curve of feasible states; a multiple of 8. The grid leaves an error of its own, inverse to "
         "their number: under 0.01 N with 128 in the paper's cable. Take more for sensors that are as good as that."},
        {8, true, 100000}, std::int64_t{default_curve_points},
        [](auto& plan, int) -> auto& { return plan.curve_points; }));
}

}  // namespace capstan::config
