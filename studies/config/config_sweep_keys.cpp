#include "capstan/config/config_key_makers.h"
#include "capstan/config/config_study_keys.h"

namespace capstan::config {

namespace {

using StudyKey = ConfigKey<StudyPlan>;

StudyKey swept_ratio(std::string name, const std::string& what, std::vector<double> Sweep::*list) {
    StudyKey key = number_list<StudyPlan>(
        {"sweep", std::move(name), "", "Factors on " + what + ", one study each; empty: the value above."},
        above_zero, {}, [list](auto& plan, int) -> auto& { return plan.sweep.*list; });
    key.allowed.may_be_empty = true;
    return key;
}

StudyKey swept_segments() {
    StudyKey key{"sweep", "segments", {ValueKind::integers, "", {2, true, max_estimated_segments}}};
    key.help = "Numbers of segments, one study each; empty: the value above.";
    key.default_value = std::vector<std::int64_t>{};
    key.read = [](const StudyPlan& plan, int) -> ConfigValue {
        return std::vector<std::int64_t>(plan.sweep.segments.begin(), plan.sweep.segments.end());
    };
    key.write = [](StudyPlan& plan, int, const ConfigValue& value) {
        const auto& given = std::get<std::vector<std::int64_t>>(value);
        plan.sweep.segments.assign(given.begin(), given.end());
    };
    return key;
}

}  // namespace

void add_sweep_keys(std::vector<ConfigKey<StudyPlan>>& keys) {
    keys.push_back(swept_ratio("friction_ratio", "both friction coefficients", &Sweep::friction_ratio));
    keys.push_back(swept_ratio("curvature_ratio", "the curvature of every bend (its radius is divided)",
                               &Sweep::curvature_ratio));
    keys.push_back(swept_ratio("stiffness_ratio", "the cable's axial stiffness", &Sweep::stiffness_ratio));
    keys.push_back(swept_segments());
    keys.push_back(integer(
        {"sweep", "instants_per_regime", "",
         "The samples that are in a regime depend on the transmission. Use this many of them, evenly "
         "spread, instead of the regime's samples. 0: use the regime's samples."},
        {0, true, 1e6}, std::int64_t{0},
        [](auto& plan, int) -> auto& { return plan.sweep.instants_per_regime; }));
}

}  // namespace capstan::config
