// Where the nodes of a plan's cable lie, and what is wrong with the cable.
#include "capstan/cable/cable_cut.h"
#include "capstan/plan/study_plan.h"

namespace capstan {

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
