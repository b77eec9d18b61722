#include "capstan/cable/cable_cut.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace capstan {

double length_m(const std::vector<CurvaturePiece>& pieces) {
    double length = 0.0;
    for (const CurvaturePiece& piece : pieces) length += piece.length_m;
    return length;
}

double wrap_rad(const std::vector<CurvaturePiece>& pieces) {
    double wrap = 0.0;
    for (const CurvaturePiece& piece : pieces) wrap += piece.length_m / piece.bend_radius_m;
    return wrap;
}

double wrap_between_rad(const std::vector<CurvaturePiece>& pieces, double from_m, double to_m) {
    double wrap_rad = 0.0;
    double start_m = 0.0;
    for (const CurvaturePiece& piece : pieces) {
        const double end_m = start_m + piece.length_m;
        const double overlap_m = std::min(to_m, end_m) - std::max(from_m, start_m);
        if (overlap_m > 0.0) wrap_rad += overlap_m / piece.bend_radius_m;
        start_m = end_m;
    }
    return wrap_rad;
}

std::vector<double> bend_ends_m(const std::vector<CurvaturePiece>& pieces) {
    std::vector<double> places_m;
    double at_m = 0.0;
    for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
        at_m += pieces[k].length_m;
        if (pieces[k].bend_radius_m < straight || pieces[k + 1].bend_radius_m < straight)
            places_m.push_back(at_m);
    }
    return places_m;
}

std::vector<double> distinct_places_m(std::vector<double> places_m, double length_m) {
    std::stable_sort(places_m.begin(), places_m.end());
    std::vector<double> distinct;
    for (const double place_m : places_m) {
        const double before_m = distinct.empty() ? 0.0 : distinct.back();
        if (place_m - before_m > same_place_m && length_m - place_m > same_place_m)
            distinct.push_back(place_m);
    }
    return distinct;
}

std::vector<double> nodes_between(const std::vector<double>& fixed_m,
                                  const std::vector<double>& turn_rad_per_m, int segments) {
    std::vector<int> parts(fixed_m.size() - 1, 1);
    const auto size = [&](std::size_t k) {
        const double part_m = (fixed_m[k + 1] - fixed_m[k]) / parts[k];
        return std::pair(turn_rad_per_m[k] * part_m, part_m);
    };
    for (int left = segments - static_cast<int>(parts.size()); left > 0; --left) {
        std::size_t largest = 0;
        for (std::size_t k = 1; k < parts.size(); ++k)
            if (size(k) > size(largest)) largest = k;
        ++parts[largest];
    }
    std::vector<double> nodes_m;
    for (std::size_t k = 0; k < parts.size(); ++k)
        for (int part = 0; part < parts[k]; ++part)
            nodes_m.push_back(fixed_m[k] + (fixed_m[k + 1] - fixed_m[k]) * part / parts[k]);
    nodes_m.push_back(fixed_m.back());
    return nodes_m;
}

std::vector<double> node_positions_m(const CableSpecification& specification) {
    std::vector<double> fixed_m = {0.0};
    fixed_m.insert(fixed_m.end(), specification.node_places_m.begin(), specification.node_places_m.end());
    fixed_m.push_back(length_m(specification.curvature));
    return nodes_between(fixed_m, std::vector<double>(fixed_m.size() - 1, 0.0), specification.segments);
}

CableSpecification refined(CableSpecification specification, int pieces) {
    if (!specification.node_places_m.empty()) {
        const std::vector<double> nodes_m = node_positions_m(specification);
        std::vector<double> finer_m;
        for (std::size_t node = 0; node + 1 < nodes_m.size(); ++node)
            for (int piece = 0; piece < pieces; ++piece)
                finer_m.push_back(nodes_m[node] + (nodes_m[node + 1] - nodes_m[node]) * piece / pieces);
        specification.node_places_m.assign(finer_m.begin() + 1, finer_m.end());
    }
    specification.segments *= pieces;
    return specification;
}

CableSpecification with_straight_joined(CableSpecification specification) {
    const Cable cable(specification);
    const auto is_straight = [&](int segment) {
        return cable.wrap_angle_rad()[static_cast<std::size_t>(segment)] < smallest_wrap_rad;
    };
    std::vector<double> kept_m;
    for (int node = 1; node < cable.segments(); ++node)
        if (!is_straight(node - 1) || !is_straight(node)) kept_m.push_back(cable.node_position_m(node));
    const int segments = static_cast<int>(kept_m.size()) + 1;
    if (segments == specification.segments) return specification;
    specification.node_places_m = std::move(kept_m);
    specification.segments = segments;
    return specification;
}

}  // namespace capstan
