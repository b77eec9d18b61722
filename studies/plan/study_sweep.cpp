#include <algorithm>
#include <cstdio>
#include <numeric>

#include "capstan/cable/invalid_input.h"
#include "capstan/plan/study_plan.h"

namespace capstan {

namespace {

std::vector<double> or_unchanged(const std::vector<double>& ratios) {
    return ratios.empty() ? std::vector<double>{1.0} : ratios;
}

std::string ratio_words(const std::vector<double>& list, const char* what, double ratio) {
    if (list.empty()) return {};
    char text[64];
    std::snprintf(text, sizeof text, ", %s x%g", what, ratio);
    return text;
}

// Explicit layouts and numbers of sensors are kept; "all" means all numbers of the new cable.
void cut_into(StudyPlan& plan, int segments) {
    const int before = plan.transmission.cable.segments;
    plan.transmission.cable.segments = segments;
    place_nodes(plan);
    if (static_cast<int>(plan.sensor_counts.size()) != before + 1) return;
    plan.sensor_counts.resize(segments + 1);
    std::iota(plan.sensor_counts.begin(), plan.sensor_counts.end(), 1);
}

void scale_curvature(StudyPlan& plan, double ratio) {
    for (auto& piece : plan.transmission.cable.curvature) piece.bend_radius_m /= ratio;
}

std::vector<int> spread_over(const std::vector<int>& samples, int instants) {
    std::vector<int> chosen;
    const std::size_t wanted = std::min(samples.size(), static_cast<std::size_t>(instants));
    for (std::size_t k = 0; k < wanted; ++k)
        chosen.push_back(samples[(2 * k + 1) * samples.size() / (2 * wanted)]);
    return chosen;
}

void choose_instants(StudyPlan& plan, int instants, std::vector<KeyProblem>& problems) {
    const auto samples = samples_by_regime(plan);
    for (RegimeInstants& regime : plan.regimes) {
        const auto found = samples.find(regime.regime);
        if (found == samples.end()) {
            problems.push_back({"sweep", "in '" + plan.name + "' the motion is never in the regime " +
                                             std::string(name_of(regime.regime)) +
                                             "; change the motion's amplitude, or leave this value or regime "
                                             "out"});
            continue;
        }
        regime.samples = spread_over(found->second, instants);
    }
}

}  // namespace

std::vector<StudyPlan> studies_in_sweep(const StudyPlan& plan) {
    if (!plan.sweep.is_there()) return {plan};
    const Sweep& sweep = plan.sweep;
    const std::vector<int> all_segments =
        sweep.segments.empty() ? std::vector<int>{plan.transmission.cable.segments} : sweep.segments;
    std::vector<StudyPlan> studies;
    std::vector<KeyProblem> problems;
    for (const int segments : all_segments) {
        for (const double friction : or_unchanged(sweep.friction_ratio)) {
            for (const double curvature : or_unchanged(sweep.curvature_ratio)) {
                for (const double stiffness : or_unchanged(sweep.stiffness_ratio)) {
                    StudyPlan study = plan;
                    study.sweep = {};
                    cut_into(study, segments);
                    study.transmission.cable.dynamic_friction *= friction;
                    study.transmission.cable.static_friction *= friction;
                    scale_curvature(study, curvature);
                    study.transmission.cable.axial_stiffness_N *= stiffness;
                    study.name += ": " + std::to_string(segments) + " segments" +
                                  ratio_words(sweep.friction_ratio, "friction", friction) +
                                  ratio_words(sweep.curvature_ratio, "curvature", curvature) +
                                  ratio_words(sweep.stiffness_ratio, "stiffness", stiffness);
                    if (sweep.instants_per_regime > 0)
                        choose_instants(study, sweep.instants_per_regime, problems);
                    studies.push_back(std::move(study));
                }
            }
        }
    }
    if (!problems.empty()) throw InvalidInput(problems);
    return studies;
}

}  // namespace capstan
