#include "capstan/placement/study_plan.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/estimation/fusion_method.h"
#include "capstan/placement/true_motion.h"

namespace capstan {

namespace {

using Problems = std::vector<std::string>;

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

void check_motion(const TrueMotion& motion, Problems& problems) {
    if (!usable(motion.sample_rate_Hz) || motion.sample_rate_Hz <= 0.0) {
        problems.push_back("motion.sample_rate_Hz is " + number(motion.sample_rate_Hz) +
                           ", but must be above 0");
    }
    if (motion.samples < 1) problems.push_back("motion.samples must be at least 1");
    const auto check_end = [&](const EndMotion& end, const std::string& where) {
        if (!usable(end.amplitude) || !usable(end.frequency_Hz) || !usable(end.phase_rad) ||
            end.frequency_Hz < 0) {
            problems.push_back(where +
                               ": amplitude, frequency_Hz and phase_rad must be finite numbers, the "
                               "frequency not negative");
        }
        if (!(end.start_s >= 0.0) || !(end.stop_s > end.start_s)) {
            problems.push_back(where + ": start_s must be 0 or more, and stop_s later");
        }
        if (end.kind == EndKind::spring &&
            (!usable(end.spring_stiffness_N_per_m) || end.spring_stiffness_N_per_m <= 0.0)) {
            problems.push_back(where + ".spring_stiffness_N_per_m must be above 0 for a spring");
        }
    };
    check_end(motion.proximal, "motion.proximal");
    check_end(motion.distal, "motion.distal");
    if (motion.proximal.kind == EndKind::tension && motion.distal.kind == EndKind::tension) {
        problems.push_back(
            "motion: a tension is prescribed at both ends, so the displacement is undetermined; "
            "make one kind \"position\" or \"spring\"");
    }
}

void check_sensors(const StudyPlan& plan, int nodes, Problems& problems) {
    for (const std::string& family : plan.layout_families) {
        if (!find_layout_family(family)) {
            problems.push_back("layouts.families: unknown layout family \"" + family + "\"; there are " +
                               known_names(layout_families()));
        }
    }
    for (const int count : plan.sensor_counts) {
        if (count < 1 || count > nodes) {
            problems.push_back("layouts.counts: " + std::to_string(count) + " sensors do not fit on " +
                               std::to_string(nodes) + " nodes; use 1 to " + std::to_string(nodes));
        }
    }
    for (const std::vector<int>& layout : plan.explicit_layouts) {
        const std::string where = "layouts.explicit [" + nodes_as_people_count(layout) + "]: ";
        if (layout.empty())
            problems.push_back("layouts.explicit: an empty layout has no sensor; take it out");
        for (const int node : layout) {
            if (node < 0 || node >= nodes) {
                problems.push_back(where + "node " + std::to_string(node + 1) +
                                   " is outside the cable, whose nodes are 1 to " + std::to_string(nodes));
            }
        }
        if (std::set<int>(layout.begin(), layout.end()).size() != layout.size()) {
            problems.push_back(where + "a node is named twice");
        }
    }
    if (plan.explicit_layouts.empty() && (plan.layout_families.empty() || plan.sensor_counts.empty())) {
        problems.push_back(
            "layouts: there is no layout; name families and counts, or explicit sets of nodes");
    }
}

bool uses_weights(const StudyPlan& plan) {
    return std::any_of(plan.fusion_methods.begin(), plan.fusion_methods.end(), [](const std::string& name) {
        const FusionMethod* method = find_fusion_method(name);
        return method != nullptr && method->uses_weights;
    });
}

void check_estimation(const StudyPlan& plan, Problems& problems) {
    if (plan.fusion_methods.empty()) problems.push_back("estimation.methods: no fusion method is named");
    for (const std::string& method : plan.fusion_methods) {
        if (!find_fusion_method(method)) {
            problems.push_back("estimation.methods: unknown fusion method \"" + method + "\"; there are " +
                               known_names(fusion_methods()));
        }
    }
    const bool has_mass = std::any_of(plan.regimes.begin(), plan.regimes.end(), [](const RegimeInstants& r) {
        return r.regime == Regime::mass && !r.samples.empty();
    });
    if (uses_weights(plan) && plan.weight_source == WeightSource::mass_motion && !has_mass) {
        problems.push_back(
            "estimation.weights is \"mass_motion\", but no instant is in the regime mass; add one "
            "or use \"same_regime\"");
    }
    if (!(plan.largest_distal_increment_m > 0.0) || !usable(plan.largest_distal_increment_m)) {
        problems.push_back(
            "estimation.largest_distal_increment_m must be above 0: how far the distal end may "
            "move in one sample");
    }
    if (plan.curve_points < 8 || plan.curve_points % 8 != 0) {
        problems.push_back("estimation.curve_points is " + std::to_string(plan.curve_points) +
                           ", but must be a multiple of 8");
    }
}

void check_noise(const StudyPlan& plan, Problems& problems) {
    if (plan.noise_levels.empty()) problems.push_back("noise: no noise level is given; add a [[noise]]");
    std::set<std::string> labels;
    for (const NamedNoise& noise : plan.noise_levels) {
        const NoiseLevel& level = noise.level;
        for (const double value :
             {level.multiplicative_ratio, level.additive_N, level.bias_N, level.quantisation_N}) {
            if (!usable(value) || value < 0.0) {
                problems.push_back("noise \"" + noise.label + "\": " + number(value) +
                                   " is no size of a noise; "
                                   "every part must be 0 or more");
            }
        }
        if (!(level.range_N > 0.0)) {
            problems.push_back("noise \"" + noise.label + "\": range_N must be above 0: the largest reading");
        }
        if (!labels.insert(noise.label).second) {
            problems.push_back("noise: the label \"" + noise.label + "\" is used twice");
        }
    }
}

void check_regimes(const StudyPlan& plan, Problems& problems) {
    double duty = 0.0;
    int instants = 0;
    std::set<Regime> seen;
    for (const RegimeInstants& regime : plan.regimes) {
        const std::string where = "regime " + std::string(name_of(regime.regime));
        if (!seen.insert(regime.regime).second)
            problems.push_back(where + " is given twice; give all its samples at once");
        if (regime.samples.empty())
            problems.push_back(where + ": samples is empty; name at least one instant");
        instants += static_cast<int>(regime.samples.size());
        duty += regime.duty_fraction;
        if (!(regime.duty_fraction >= 0.0 && regime.duty_fraction <= 1.0)) {
            problems.push_back(where + ": duty_fraction is " + number(regime.duty_fraction) +
                               ", but must be 0 to 1");
        }
        for (const int sample : regime.samples) {
            if (sample < 1 || sample > plan.motion.samples) {
                problems.push_back(where + ": sample " + std::to_string(sample) +
                                   " is outside the motion, whose "
                                   "samples are 1 to " +
                                   std::to_string(plan.motion.samples));
            }
        }
    }
    if (instants == 0) problems.push_back("regime: no instant is named; add a [[regime]] with samples");
    if (instants > 0 && !(std::abs(duty - 1.0) < 1e-9)) {
        problems.push_back("regime: the duty_fraction values sum to " + number(duty) + ", but must sum to 1");
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
    for (const RegimeInstants& regime : plan.regimes) {
        const auto found = samples.find(regime.regime);
        const std::vector<int> those = found == samples.end() ? std::vector<int>{} : found->second;
        for (const int sample : regime.samples) {
            if (std::binary_search(those.begin(), those.end(), sample)) continue;
            const std::string name(name_of(regime.regime));
            problems.push_back(
                "regime " + name + ": at sample " + std::to_string(sample) +
                " the motion is not in this regime; " +
                (those.empty() ? "it never is in this motion" : "samples that are: " + as_ranges(those)));
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

std::vector<std::string> problems_of(const StudyPlan& plan) {
    Problems problems;
    if (plan.name.empty()) problems.push_back("name is empty; a study is found again by its name");
    if (plan.repetitions < 2) problems.push_back("repetitions must be at least 2: one draw has no spread");
    if (!(plan.worthwhile_gain_N >= 0.0))
        problems.push_back("recommendation.worthwhile_gain_N must be 0 or more");
    try {
        const Cable cable(plan.transmission.cable);
        if (cable.segments() > max_estimated_segments) {
            problems.push_back("transmission.segments is " + std::to_string(cable.segments()) +
                               ", but a study takes at most " + std::to_string(max_estimated_segments));
        }
    } catch (const InvalidInput& invalid) {
        for (const std::string& problem : invalid.problems()) problems.push_back("transmission: " + problem);
    }
    check_motion(plan.motion, problems);
    check_regimes(plan, problems);
    check_noise(plan, problems);
    check_sensors(plan, plan.transmission.cable.segments + 1, problems);
    check_estimation(plan, problems);
    for (std::string& problem : problems_of(plan.placement, plan.transmission.cable.segments + 1)) {
        problems.push_back(std::move(problem));
    }
    for (std::string& problem : problems_of_truth(plan)) problems.push_back(std::move(problem));
    if (problems.empty()) check_instants(plan, problems);
    return problems;
}

}  // namespace capstan
