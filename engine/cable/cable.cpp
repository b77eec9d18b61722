#include "capstan/cable/cable.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "capstan/cable/cable_cut.h"
#include "capstan/cable/invalid_input.h"

namespace capstan {

namespace {

// Finite and above zero; also false for NaN.
bool positive(double value) {
    return std::isfinite(value) && value > 0.0;
}
bool not_negative(double value) {
    return std::isfinite(value) && value >= 0.0;
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

std::vector<KeyProblem> problems_of_pieces(const std::vector<CurvaturePiece>& pieces) {
    std::vector<KeyProblem> problems;
    if (pieces.empty()) problems.push_back({"curvature", "no piece is given; a cable needs at least one"});
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const std::string piece = "curvature[" + std::to_string(k + 1) + "]";
        const double radius = pieces[k].bend_radius_m;
        if (!positive(pieces[k].length_m)) {
            problems.push_back(
                {piece + ".length_m", "is " + number(pieces[k].length_m) +
                                          ", but must be above 0; give it, or an angle and a bend radius"});
        }
        if (std::isnan(radius) || radius <= 0.0) {
            problems.push_back(
                {piece + ".bend_radius_m",
                 "is " + number(radius) + ", but must be above 0 (leave it out for a straight piece)"});
        }
    }
    return problems;
}

void check_node_places(const CableSpecification& s, std::vector<KeyProblem>& problems) {
    double before_m = 0.0;
    for (const double place_m : s.node_places_m) {
        if (!(place_m > before_m) || !(place_m < length_m(s.curvature))) {
            problems.push_back({"node_places_m", "a node at " + number(place_m) +
                                                     " m; the places must rise and lie between both ends"});
            return;
        }
        before_m = place_m;
    }
    const std::size_t needed = s.node_places_m.size() + 1;
    if (static_cast<std::size_t>(s.segments) < needed) {
        problems.push_back({"segments", "is " + std::to_string(s.segments) + ", but nodes at " +
                                            std::to_string(needed - 1) +
                                            " places between the ends need at least " +
                                            std::to_string(needed) + " segments"});
    }
}

}  // namespace

std::vector<KeyProblem> problems_of(const CableSpecification& s) {
    std::vector<KeyProblem> problems = problems_of_pieces(s.curvature);
    const auto demand = [&](bool holds, const char* name, double value, const std::string& rule) {
        if (!holds) problems.push_back({name, "is " + number(value) + rule});
    };
    demand(s.segments >= 1, "segments", s.segments, ", but must be at least 1");
    demand(positive(s.axial_stiffness_N), "axial_stiffness_N", s.axial_stiffness_N, ", but must be above 0");
    demand(not_negative(s.dynamic_friction), "dynamic_friction", s.dynamic_friction,
           ", but must be 0 or more");
    demand(not_negative(s.static_friction) && !(s.static_friction < s.dynamic_friction), "static_friction",
           s.static_friction,
           ", below dynamic_friction " + number(s.dynamic_friction) +
               "; a segment at rest holds at least as much as one that slides");
    demand(not_negative(s.pretension_N), "pretension_N", s.pretension_N, ", but must be 0 or more");
    if (!problems.empty()) return problems;

    const double exponent = s.static_friction * wrap_rad(s.curvature);
    if (!(exponent <= largest_friction_exponent)) {
        problems.push_back(
            {"curvature", "static_friction times the wrap angle is " + number(exponent) +
                              ", but must be at most 300: beyond, the far end feels nothing; check "
                              "bend_radius_m"});
    }
    check_node_places(s, problems);
    return problems;
}

Cable::Cable(const CableSpecification& specification)
    : is_evenly_cut_(specification.node_places_m.empty()),
      length_m_(capstan::length_m(specification.curvature)),
      axial_stiffness_N_(specification.axial_stiffness_N),
      dynamic_friction_(specification.dynamic_friction),
      static_friction_(specification.static_friction),
      pretension_N_(specification.pretension_N) {
    if (const auto problems = problems_of(specification); !problems.empty()) throw InvalidInput(problems);

    const int count = specification.segments;
    wrap_angle_rad_.resize(count);
    if (is_evenly_cut_) {
        for (int node = 0; node <= count; ++node) {
            relative_position_.push_back(node);
            node_position_m_.push_back(node * mean_segment_length_m());
        }
    } else {
        node_position_m_ = node_positions_m(specification);
        for (const double position_m : node_position_m_)
            relative_position_.push_back(position_m / mean_segment_length_m());
        relative_position_.back() = count;
    }
    const auto end_of_segment_m = [&](int node) {
        return is_evenly_cut_ ? length_m_ * node / count : node_position_m_[node];
    };
    for (int i = 0; i < count; ++i) {
        relative_length_.push_back(relative_position_[i + 1] - relative_position_[i]);
        wrap_angle_rad_[i] =
            wrap_between_rad(specification.curvature, end_of_segment_m(i), end_of_segment_m(i + 1));
    }
}

Cable::Spot Cable::spot_at(double position_m) const {
    const double place = std::clamp(position_m / mean_segment_length_m(), 0.0, 1.0 * segments());
    const auto beyond = std::upper_bound(relative_position_.begin(), relative_position_.end(), place);
    const int segment = std::min(static_cast<int>(beyond - relative_position_.begin()), segments()) - 1;
    return {segment, (place - relative_position_[segment]) / relative_length_[segment]};
}

int Cable::nearest_node(double position_m) const {
    const Spot spot = spot_at(position_m);
    return spot.segment + (spot.fraction < 0.5 ? 0 : 1);
}

}  // namespace capstan
