// Where the nodes of a plan's cable lie, and what is wrong with the cable.
#include <algorithm>

#include "capstan/cable/cable_cut.h"
#include "capstan/estimation/direction_pattern.h"
#include "capstan/plan/study_plan.h"

namespace capstan {

namespace {

// A segment breaks away as a whole. Until then it holds back the static friction beyond the dynamic one, an
// error that is proportional to the segment; the rest of the error falls with its square. With a friction
// exponent of 0.3 beyond the dynamic one half of an error was discretisation, so that a tenth of it leaves a
// twentieth.
constexpr double max_static_exponent_beyond_dynamic = 0.03;
constexpr double max_dynamic_exponent = 0.1;

}  // namespace

void place_nodes(StudyPlan& plan) {
    CableSpecification& cable = plan.transmission.cable;
    cable.node_places_m.clear();
    if (plan.transmission.cut == CableCut::even) return;
    std::vector<double> places_m = bend_ends_m(cable.curvature);
    for (const SensorRow& row : plan.sensors)
        if (row.kind == SensorKind::tension)
            places_m.insert(places_m.end(), row.places_m.begin(), row.places_m.end());
    cable.node_places_m = distinct_places_m(std::move(places_m), length_m(cable.curvature));
}

int default_segments(const StudyPlan& plan) {
    CableSpecification cable = plan.transmission.cable;
    const double beyond = std::max(cable.static_friction - cable.dynamic_friction, 0.0);
    const auto is_fine = [&] {
        const Cable cut(cable);
        const double wrap_rad = *std::max_element(cut.wrap_angle_rad().begin(), cut.wrap_angle_rad().end());
        return beyond * wrap_rad <= max_static_exponent_beyond_dynamic &&
               cable.dynamic_friction * wrap_rad <= max_dynamic_exponent;
    };
    constexpr int fewest = 10;  // a node at every tenth of a straight cable
    cable.segments = std::max(fewest, static_cast<int>(cable.node_places_m.size()) + 1);
    if (!problems_of(cable).empty()) return cable.segments;
    while (cable.segments < max_estimated_segments && !is_fine()) ++cable.segments;
    return cable.segments;
}

std::vector<KeyProblem> problems_of_cable(const StudyPlan& plan) {
    const CableSpecification& cable = plan.transmission.cable;
    std::vector<KeyProblem> problems;
    for (const KeyProblem& problem : problems_of(cable)) {
        const bool too_few = problem.key == "segments" && !cable.node_places_m.empty();
        problems.push_back(
            {"transmission." + problem.key,
             problem.message + (too_few ? " (the ends of bends and the tension sensors' places); "
                                          "raise it, or set transmission.cut = \"even\""
                                        : "")});
    }
    if (!cable.node_places_m.empty() && !plan.uncertainty.is_stated &&
        plan.placement.max_in_distal_half < cable.segments)
        problems.push_back({"placement.max_in_distal_half",
                            "counts nodes, of which as many lie in either half of the cable only with "
                            "transmission.cut = \"even\""});
    return problems;
}

}  // namespace capstan
