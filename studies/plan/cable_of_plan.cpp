// Where the nodes of a plan's cable lie, and what is wrong with the cable.
#include <algorithm>

#include "capstan/cable/cable_cut.h"
#include "capstan/estimation/direction_pattern.h"
#include "capstan/plan/study_plan.h"

namespace capstan {

namespace {

// All of a segment breaks away at once. Until then it holds back the static friction beyond the dynamic one, an
// error that is proportional to the segment; the rest of the error falls with its square. With a friction
// exponent of 0.3 beyond the dynamic one half of an error was discretisation, so that a tenth of it leaves a
// twentieth.
constexpr double max_static_exponent_beyond_dynamic = 0.03;
constexpr double max_dynamic_exponent = 0.1;

double bend_radius_at(const std::vector<CurvaturePiece>& pieces, double place_m) {
    double end_m = 0.0;
    for (const CurvaturePiece& piece : pieces)
        if (place_m < (end_m += piece.length_m)) return piece.bend_radius_m;
    return straight;
}

// All inner nodes: those places, which bends begin and end at, and the others in the bends.
std::vector<double> with_nodes_in_bends(const std::vector<double>& places_m,
                                        const CableSpecification& cable) {
    std::vector<double> fixed_m{0.0};
    fixed_m.insert(fixed_m.end(), places_m.begin(), places_m.end());
    fixed_m.push_back(length_m(cable.curvature));
    std::vector<double> turn_rad_per_m;
    for (std::size_t k = 0; k + 1 < fixed_m.size(); ++k)
        turn_rad_per_m.push_back(1.0 / bend_radius_at(cable.curvature, 0.5 * (fixed_m[k] + fixed_m[k + 1])));
    const std::vector<double> nodes_m = nodes_between(fixed_m, turn_rad_per_m, cable.segments);
    return {nodes_m.begin() + 1, nodes_m.end() - 1};
}

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
    if (plan.transmission.cut == CableCut::in_bends)
        cable.node_places_m = with_nodes_in_bends(cable.node_places_m, cable);
}

int default_segments(StudyPlan plan) {
    CableSpecification& cable = plan.transmission.cable;
    const double beyond = std::max(cable.static_friction - cable.dynamic_friction, 0.0);
    const auto is_fine = [&] {
        const Cable cut(cable);
        const double wrap_rad = *std::max_element(cut.wrap_angle_rad().begin(), cut.wrap_angle_rad().end());
        return beyond * wrap_rad <= max_static_exponent_beyond_dynamic &&
               cable.dynamic_friction * wrap_rad <= max_dynamic_exponent;
    };
    constexpr int fewest = 10;  // a node at every tenth of a straight cable
    cable.segments = 1;
    place_nodes(plan);
    cable.segments = std::max(fewest, static_cast<int>(cable.node_places_m.size()) + 1);
    place_nodes(plan);
    if (!problems_of(cable).empty()) return cable.segments;
    while (cable.segments < max_estimated_segments && !is_fine()) {
        ++cable.segments;
        place_nodes(plan);
    }
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
