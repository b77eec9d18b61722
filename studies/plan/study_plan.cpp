#include "capstan/plan/study_plan.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "capstan/cable/cable_cut.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/estimation/fusion_method.h"
#include "capstan/plan/true_motion.h"

namespace capstan {

namespace {

using Problems = std::vector<KeyProblem>;

bool usable(double value) {
    return std::isfinite(value);
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

std::string known_names(const auto& catalogue) {
    std::string names;
    for (const auto& entry : catalogue) names += (names.empty() ? "" : ", ") + std::string(entry.name);
    return names;
}

void check_end(const EndMotion& end, const std::string& section, Problems& problems) {
    if (!usable(end.amplitude) || !usable(end.frequency_Hz) || !usable(end.phase_rad) ||
        end.frequency_Hz < 0) {
        problems.push_back(
            {section,
             "amplitude, frequency_Hz and phase_rad must be finite numbers, and the frequency must "
             "not be negative"});
    }
    if (!(end.start_s >= 0.0) || !(end.stop_s > end.start_s))
        problems.push_back({section + ".start_s", "must be 0 or more, and stop_s must be later"});
    if (end.kind == EndKind::spring &&
        (!usable(end.spring_stiffness_N_per_m) || end.spring_stiffness_N_per_m <= 0.0)) {
        problems.push_back({section + ".spring_stiffness_N_per_m", "must be above 0 for a spring"});
    }
}

void check_motion(const TrueMotion& motion, Problems& problems) {
    if (!usable(motion.sample_rate_Hz) || motion.sample_rate_Hz <= 0.0)
        problems.push_back(
            {"motion.sample_rate_Hz", "is " + number(motion.sample_rate_Hz) + ", but must be above 0"});
    if (motion.samples < 1) problems.push_back({"motion.samples", "must be at least 1"});
    check_end(motion.proximal, "motion.proximal", problems);
    check_end(motion.distal, "motion.distal", problems);
    if (motion.proximal.kind == EndKind::tension && motion.distal.kind == EndKind::tension) {
        problems.push_back(
            {"motion.distal.kind",
             "\"tension\" at both ends leaves the cable's position undetermined; make one end a "
             "position or a spring"});
    }
}

void check_families(const StudyPlan& plan, int nodes, Problems& problems) {
    for (const std::string& family : plan.layout_families) {
        if (!find_layout_family(family)) {
            problems.push_back({"layouts.families", "unknown layout family \"" + family + "\"; there are " +
                                                        known_names(layout_families())});
        }
    }
    for (const int count : plan.sensor_counts) {
        if (count < 1 || count > nodes) {
            problems.push_back({"layouts.counts", std::to_string(count) + " sensors do not fit on " +
                                                      std::to_string(nodes) + " nodes; use 1 to " +
                                                      std::to_string(nodes) + ", or \"all\""});
        }
    }
}

void check_explicit_layouts(const StudyPlan& plan, int nodes, Problems& problems) {
    for (const std::vector<int>& layout : plan.explicit_layouts) {
        if (layout.empty())
            problems.push_back({"layouts.explicit", "an empty layout has no sensor; take it out"});
        for (const int node : layout) {
            if (node < 0 || node >= nodes) {
                problems.push_back({"layouts.explicit", "a sensor at node " + std::to_string(node + 1) +
                                                            " is outside the cable, whose nodes are 1 to " +
                                                            std::to_string(nodes) +
                                                            "; move it, or raise transmission.segments"});
            }
        }
        if (std::set<int>(layout.begin(), layout.end()).size() != layout.size()) {
            problems.push_back(
                {"layouts.explicit", "[" + nodes_as_people_count(layout) + "]: a node is named twice"});
        }
    }
}

void check_sensors(const StudyPlan& plan, int nodes, Problems& problems) {
    check_families(plan, nodes, problems);
    check_explicit_layouts(plan, nodes, problems);
    if (plan.explicit_layouts.empty() && (plan.layout_families.empty() || plan.sensor_counts.empty())) {
        problems.push_back(
            {"layouts", "there is no layout; give families with counts, or explicit sets of nodes"});
    }
}

bool uses_weights(const StudyPlan& plan) {
    return std::any_of(plan.fusion_methods.begin(), plan.fusion_methods.end(), [](const std::string& name) {
        const FusionMethod* method = find_fusion_method(name);
        return method != nullptr && method->uses_weights;
    });
}

void check_methods(const StudyPlan& plan, Problems& problems) {
    if (plan.fusion_methods.empty())
        problems.push_back({"estimation.methods", "is empty; name fusion methods, or write \"all\""});
    for (const std::string& method : plan.fusion_methods) {
        if (!find_fusion_method(method)) {
            problems.push_back({"estimation.methods", "unknown fusion method \"" + method + "\"; there are " +
                                                          known_names(fusion_methods())});
        }
    }
    const bool has_mass = std::any_of(plan.regimes.begin(), plan.regimes.end(), [](const RegimeInstants& r) {
        return r.regime == Regime::mass && !r.samples.empty();
    });
    if (uses_weights(plan) && plan.weight_source == WeightSource::mass_motion && !has_mass) {
        problems.push_back({"estimation.weights",
                            "is \"mass_motion\", but no instant is in the regime mass; add one, or use "
                            "\"same_regime\""});
    }
}

void check_feasible_curve(const StudyPlan& plan, Problems& problems) {
    if (!(plan.largest_distal_increment_m > 0.0) || !usable(plan.largest_distal_increment_m)) {
        problems.push_back({"estimation.largest_distal_increment_m",
                            "must be above 0: how far the distal end may move in one sample"});
    }
    if (plan.curve_points < 8 || plan.curve_points % 8 != 0) {
        problems.push_back({"estimation.curve_points",
                            "is " + std::to_string(plan.curve_points) + ", but must be a multiple of 8"});
    }
}

void check_noise(const StudyPlan& plan, Problems& problems) {
    if (plan.noise_levels.empty()) problems.push_back({"noise", "no noise level is given; add a [[noise]]"});
    std::set<std::string> labels;
    for (std::size_t k = 0; k < plan.noise_levels.size(); ++k) {
        const NamedNoise& noise = plan.noise_levels[k];
        const std::string section = "noise[" + std::to_string(k + 1) + "]";
        const NoiseLevel& level = noise.level;
        for (const double value :
             {level.multiplicative_ratio, level.additive_N, level.bias_N, level.quantisation_N}) {
            if (!usable(value) || value < 0.0) {
                problems.push_back({section, number(value) +
                                                 " is not the size of a noise; every part must be 0 "
                                                 "or more"});
            }
        }
        if (!(level.range_N > 0.0))
            problems.push_back({section + ".range_N", "must be above 0: the largest reading"});
        if (!labels.insert(noise.label).second) {
            problems.push_back({section + ".label", "\"" + noise.label +
                                                        "\" is given twice; figures could not tell the two "
                                                        "levels apart"});
        }
    }
}

// The sum of the regimes' duty fractions may be off by the rounding of the digits given.
constexpr double duty_rounding = 1e-9;

void check_regime(const StudyPlan& plan, const RegimeInstants& regime, const std::string& section,
                  Problems& problems) {
    if (regime.samples.empty())
        problems.push_back({section + ".samples", "is empty; name at least one sample"});
    if (!(regime.duty_fraction >= 0.0 && regime.duty_fraction <= 1.0)) {
        problems.push_back(
            {section + ".duty_fraction", "is " + number(regime.duty_fraction) + ", but must be 0 to 1"});
    }
    for (const int sample : regime.samples) {
        if (sample >= 1 && sample <= plan.motion.samples) continue;
        problems.push_back({section + ".samples", "sample " + std::to_string(sample) +
                                                      " is outside the motion, whose samples are 1 to " +
                                                      std::to_string(plan.motion.samples) +
                                                      "; choose another, or raise motion.samples"});
    }
}

void check_regimes(const StudyPlan& plan, Problems& problems) {
    double duty = 0.0;
    std::set<Regime> seen;
    for (std::size_t k = 0; k < plan.regimes.size(); ++k) {
        const RegimeInstants& regime = plan.regimes[k];
        const std::string section = "regime[" + std::to_string(k + 1) + "]";
        if (!seen.insert(regime.regime).second) {
            problems.push_back({section + ".name", "\"" + std::string(name_of(regime.regime)) +
                                                       "\" is given twice; put all its samples into one "
                                                       "[[regime]]"});
        }
        check_regime(plan, regime, section, problems);
        duty += regime.duty_fraction;
    }
    if (plan.regimes.empty())
        problems.push_back({"regime", "no instant is named; add a [[regime]] with samples"});
    else if (!(std::abs(duty - 1.0) < duty_rounding)) {
        problems.push_back({"regime[1].duty_fraction", "the duty fractions of all regimes sum to " +
                                                           number(duty) +
                                                           ", but must sum to 1; give enough digits"});
    }
}

// "3-8, 14, 20-22", the first few runs.
std::string as_ranges(const std::vector<int>& samples) {
    std::string text;
    int runs = 0;
    for (std::size_t k = 0; k < samples.size(); ++runs) {
        std::size_t end = k;
        while (end + 1 < samples.size() && samples[end + 1] == samples[end] + 1) ++end;
        if (runs == 6) return text + ", ...";
        text += (text.empty() ? "" : ", ") + std::to_string(samples[k]) +
                (end > k ? "-" + std::to_string(samples[end]) : "");
        k = end + 1;
    }
    return text;
}

void check_instants(const StudyPlan& plan, Problems& problems) {
    const auto samples = samples_by_regime(plan);
    for (std::size_t k = 0; k < plan.regimes.size(); ++k) {
        const RegimeInstants& regime = plan.regimes[k];
        const auto found = samples.find(regime.regime);
        const std::vector<int> those = found == samples.end() ? std::vector<int>{} : found->second;
        for (const int sample : regime.samples) {
            if (std::binary_search(those.begin(), those.end(), sample)) continue;
            problems.push_back({"regime[" + std::to_string(k + 1) + "].samples",
                                "at sample " + std::to_string(sample) + " the motion is not in the regime " +
                                    std::string(name_of(regime.regime)) + "; " +
                                    (those.empty() ? "it never is in this motion"
                                                   : "samples that are: " + as_ranges(those))});
        }
    }
}

}  // namespace

std::string_view name_of(Regime regime) {
    switch (regime) {
        case Regime::mass:
            return "mass";
        case Regime::partial_proximal:
            return "partial_proximal";
        case Regime::partial_distal:
            return "partial_distal";
        case Regime::partial_both:
            return "partial_both";
    }
    return {};
}

std::map<Regime, std::vector<int>> samples_by_regime(const StudyPlan& plan) {
    std::map<Regime, std::vector<int>> samples;
    const QuasiStaticStep step(Cable(plan.transmission.cable), plan.transmission.rules);
    simulate(step, plan.motion, [&](const TrueSample& sample) {
        if (const auto regime = regime_of(sample.report.pattern)) samples[*regime].push_back(sample.sample);
    });
    return samples;
}

std::vector<KeyProblem> problems_of_values(const StudyPlan& plan) {
    Problems problems;
    if (plan.name.empty()) problems.push_back({"name", "is empty; a study is found again by its name"});
    if (plan.repetitions < 2)
        problems.push_back({"repetitions", "must be at least 2: one draw has no spread"});
    if (!(plan.worthwhile_gain_N >= 0.0))
        problems.push_back({"recommendation.worthwhile_gain_N", "must be 0 or more"});
    const CableSpecification& cable = plan.transmission.cable;
    for (KeyProblem& problem : problems_of_cable(plan)) problems.push_back(std::move(problem));
    if (plan.transmission.arrangement == CableArrangement::pull_pull && !plan.uncertainty.is_stated)
        problems.push_back({"transmission.arrangement",
                            "\"pull_pull\" needs [uncertainty]; studies at instants are for a single cable"});
    if (plan.uncertainty.is_stated) {
        check_motion(plan.motion, problems);
        check_noise(plan, problems);
        check_families(plan, cable.segments + 1, problems);
        const Problems of_worlds = problems_of_worlds(plan);
        problems.insert(problems.end(), of_worlds.begin(), of_worlds.end());
        for (KeyProblem& problem : problems_of(plan.placement, cable.segments + 1))
            problems.push_back(std::move(problem));
        for (KeyProblem& problem : problems_of_truth(plan)) problems.push_back(std::move(problem));
        return problems;
    }
    if (cable.segments > max_estimated_segments) {
        problems.push_back({"transmission.segments", "is " + std::to_string(cable.segments) +
                                                         ", but a study takes at most " +
                                                         std::to_string(max_estimated_segments)});
    }
    const int nodes = cable.segments + 1;
    check_motion(plan.motion, problems);
    check_regimes(plan, problems);
    check_noise(plan, problems);
    check_sensors(plan, nodes, problems);
    check_methods(plan, problems);
    check_feasible_curve(plan, problems);
    for (KeyProblem& problem : problems_of(plan.placement, nodes)) problems.push_back(std::move(problem));
    for (KeyProblem& problem : problems_of_truth(plan)) problems.push_back(std::move(problem));
    return problems;
}

std::vector<KeyProblem> problems_of(const StudyPlan& plan) {
    Problems problems = problems_of_values(plan);
    if (problems.empty() && !plan.uncertainty.is_stated) check_instants(plan, problems);
    return problems;
}

}  // namespace capstan
