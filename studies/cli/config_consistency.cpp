#include "capstan/cli/config_consistency.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace capstan::cli {

namespace {

class Checks {
  public:
    Checks(const ReadConfig& config, const std::vector<ConfigProblem>& known)
        : config_(config), known_(known) {}

    std::vector<ConfigProblem> run() {
        if (sound("transmission")) check_friction();
        if (sound("transmission.segments")) check_nodes();
        if (sound("layouts")) check_layouts();
        if (sound("estimation.methods")) check_methods();
        if (sound("motion")) check_ends();
        if (sound("regime") && sound("motion.samples")) check_regimes();
        if (sound("noise")) check_noise();
        return std::move(problems_);
    }

  private:
    bool sound(std::string_view path) const { return cli::sound(known_, path); }

    // At the first of these keys that stands in the file.
    void problem(std::initializer_list<std::string> keys, std::string message) {
        for (const std::string& key : keys) {
            const auto line = config_.lines.find(key);
            if (line == config_.lines.end()) continue;
            problems_.push_back({line->second, 0, key, std::move(message)});
            return;
        }
        problems_.push_back({0, 0, *keys.begin(), std::move(message)});
    }

    void check_friction() {
        const std::string message = friction_problem(config_.plan.transmission.cable);
        if (!message.empty())
            problem({"transmission.static_friction", "transmission.dynamic_friction"}, message);
    }

    void check_nodes() {
        const StudyPlan& plan = config_.plan;
        const int nodes = plan.transmission.cable.segments + 1;
        for (const int count : plan.sensor_counts) {
            if (count <= nodes) continue;
            problem({"layouts.counts"},
                    fmt::format("{} sensors do not fit on {} nodes; give counts up to {}, or \"all\"", count,
                                nodes, nodes));
        }
        for (const auto& layout : plan.explicit_layouts) {
            for (const int node : layout) {
                if (node < nodes) continue;
                problem({"layouts.explicit"},
                        fmt::format(
                            "a sensor at node {} is outside the cable, whose nodes are 1 to {}; move it, or "
                            "raise transmission.segments",
                            node + 1, nodes));
            }
        }
    }

    void check_layouts() {
        const StudyPlan& plan = config_.plan;
        const bool families = !plan.layout_families.empty() && !plan.sensor_counts.empty();
        if (!families && plan.explicit_layouts.empty()) {
            problem({"layouts.families", "layouts.counts", "layouts"},
                    "no layout to judge; give families with counts, or explicit layouts");
        }
    }

    void check_methods() {
        if (config_.plan.fusion_methods.empty())
            problem({"estimation.methods"}, "is empty; name methods, or write \"all\"");
    }

    void check_ends() {
        const TrueMotion& motion = config_.plan.motion;
        if (motion.proximal.kind == EndKind::tension && motion.distal.kind == EndKind::tension) {
            problem(
                {"motion.distal.kind"},
                "\"tension\" at both ends leaves the cable's position undetermined; make one a position or a spring");
        }
    }

    void check_regimes() {
        const StudyPlan& plan = config_.plan;
        std::set<Regime> seen;
        double duty = 0.0;
        for (std::size_t k = 0; k < plan.regimes.size(); ++k) {
            const RegimeInstants& regime = plan.regimes[k];
            const std::string path = fmt::format("regime[{}]", k + 1);
            duty += regime.duty_fraction;
            if (!seen.insert(regime.regime).second) {
                problem({path + ".name"},
                        fmt::format("\"{}\" is given twice; put all its samples into one [[regime]]",
                                    name_of(regime.regime)));
            }
            if (regime.samples.empty()) problem({path + ".samples"}, "is empty; name at least one sample");
            for (const int sample : regime.samples) {
                if (sample <= plan.motion.samples) continue;
                problem({path + ".samples"},
                        fmt::format("sample {} is beyond the motion's {} samples; choose an "
                                    "earlier one, or raise motion.samples",
                                    sample, plan.motion.samples));
            }
        }
        constexpr double rounding = 1e-9;
        if (std::abs(duty - 1.0) > rounding) {
            problem(
                {"regime[1].duty_fraction"},
                fmt::format(
                    "the duty fractions of all regimes sum to {}, but must sum to 1; give enough digits, or let one fraction be 1 less the others",
                    duty));
        }
    }

    void check_noise() {
        std::set<std::string> seen;
        const auto& levels = config_.plan.noise_levels;
        for (std::size_t k = 0; k < levels.size(); ++k) {
            if (seen.insert(levels[k].label).second) continue;
            problem(
                {fmt::format("noise[{}].label", k + 1)},
                fmt::format("\"{}\" is given twice; figures could not tell the two apart", levels[k].label));
        }
    }

    const ReadConfig& config_;
    const std::vector<ConfigProblem>& known_;
    std::vector<ConfigProblem> problems_;
};

}  // namespace

std::string friction_problem(const CableSpecification& cable) {
    if (cable.static_friction >= cable.dynamic_friction) return {};
    return fmt::format(
        "static_friction is {}, below dynamic_friction {}; a segment at rest holds at least as much as one that slides",
        cable.static_friction, cable.dynamic_friction);
}

std::vector<ConfigProblem> inconsistencies_of(const ReadConfig& config,
                                              const std::vector<ConfigProblem>& known) {
    return Checks(config, known).run();
}

}  // namespace capstan::cli
