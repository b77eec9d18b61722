#include "capstan/worlds/straight_pieces.h"

#include <algorithm>
#include <cmath>

#include "capstan/cable/cable_cut.h"

namespace capstan {

namespace {

StraightPiece piece_around(const Cable& cable, double place_m) {
    const auto is_straight = [&](int segment) {
        return segment >= 0 && segment < cable.segments() &&
               cable.wrap_angle_rad()[static_cast<std::size_t>(segment)] < smallest_wrap_rad;
    };
    const auto at_m = [&](int node) { return cable.node_position_m(node); };
    const int nearest = cable.nearest_node(place_m);
    int first = nearest;
    int last = nearest;
    if (std::abs(at_m(nearest) - place_m) > same_place_m) {
        first = cable.spot_at(place_m).segment;
        last = first + 1;
        if (!is_straight(first)) return {place_m, place_m};
    }
    while (is_straight(first - 1)) --first;
    while (is_straight(last)) ++last;
    return first == last ? StraightPiece{place_m, place_m} : StraightPiece{at_m(first), at_m(last)};
}

bool are_alike(const SensorOffer& a, const SensorOffer& b) {
    return a.kind == b.kind && a.cable == b.cable && a.errors == b.errors;
}

}  // namespace

std::vector<StraightPiece> straight_pieces(const StudyPlan& plan, const std::vector<SensorOffer>& offers) {
    const Cable cable(plan.transmission.cable);
    std::vector<StraightPiece> pieces;
    for (const SensorOffer& offer : offers) {
        const bool is_anywhere = offer.kind == SensorKind::tension && !plan.truth.has_effects();
        pieces.push_back(is_anywhere ? piece_around(cable, offer.place_m)
                                     : StraightPiece{offer.place_m, offer.place_m});
    }
    return pieces;
}

std::vector<int> first_alike(const StudyPlan& plan, const std::vector<SensorOffer>& offers) {
    const std::vector<StraightPiece> pieces = straight_pieces(plan, offers);
    std::vector<int> first;
    for (std::size_t k = 0; k < offers.size(); ++k) {
        std::size_t other = 0;
        while (!are_alike(offers[other], offers[k]) || !(pieces[other] == pieces[k])) ++other;
        first.push_back(static_cast<int>(other));
    }
    return first;
}

}  // namespace capstan
