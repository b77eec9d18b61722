#pragma once

#include <limits>
#include <span>
#include <vector>

#include "capstan/cable/invalid_input.h"

namespace capstan {

inline constexpr double straight = std::numeric_limits<double>::infinity();

/// A stretch of conduit of one bend radius, in the order from the proximal (motor) end.
struct CurvaturePiece {
    double length_m = 0.0;
    double bend_radius_m = straight;
};

/// What a maker knows of a cable in its conduit.
struct CableSpecification {
    std::vector<CurvaturePiece> curvature;
    int segments = 0;
    double axial_stiffness_N = 0.0;  ///< EA: force per unit strain, not force per elongation.
    double dynamic_friction = 0.0;   ///< mu_d, of a segment that slides.
    double static_friction = 0.0;    ///< mu_s, of a segment about to slide; at least mu_d.
    double pretension_N = 0.0;       ///< uniform tension before anything moves.
    /// Where nodes must lie beside both ends, rising; the others are spread between them so that the longest
    /// segment is as short as possible. Empty: all segments are equal.
    std::vector<double> node_places_m{};
};

/// How many cables a transmission has.
enum class CableArrangement {
    single,     ///< one cable with its far end held
    pull_pull,  ///< two cables between pulleys (E15)
};
constexpr int cables_of(CableArrangement arrangement) {
    return arrangement == CableArrangement::pull_pull ? 2 : 1;
}

/// The largest friction exponent (mu times total wrap angle) taken: beyond it a tension ratio leaves the
/// range of double precision, and the far end of a real cable feels nothing long before.
inline constexpr double largest_friction_exponent = 300.0;

/// Everything wrong with a specification, by the name of its field; empty if a cable can be made of it.
std::vector<KeyProblem> problems_of(const CableSpecification& specification);

/// A cable cut into segments; segment i joins nodes i and i + 1, all counted from 0 here (people count from
/// 1), node 0 proximal. A segment's wrap angle is that of the pieces it covers, so the cut loses no bend.
/// Lengths are relative to the mean segment, so that of an even cut they are 1 exactly. Valid when built.
class Cable {
  public:
    /// Throws InvalidInput with every problem of the specification.
    explicit Cable(const CableSpecification& specification);

    int segments() const { return static_cast<int>(wrap_angle_rad_.size()); }
    int nodes() const { return segments() + 1; }
    double length_m() const { return length_m_; }
    double mean_segment_length_m() const { return length_m_ / segments(); }
    double segment_length_m(int segment) const { return mean_segment_length_m() * relative_length_[segment]; }
    /// Elongation per newton of mean tension [m/N]: dx / EA.
    double mean_segment_compliance_m_per_N() const { return mean_segment_length_m() / axial_stiffness_N_; }
    double segment_compliance_m_per_N(int segment) const {
        return segment_length_m(segment) / axial_stiffness_N_;
    }
    double axial_stiffness_N() const { return axial_stiffness_N_; }
    double dynamic_friction() const { return dynamic_friction_; }
    double static_friction() const { return static_friction_; }
    double pretension_N() const { return pretension_N_; }
    std::span<const double> wrap_angle_rad() const { return wrap_angle_rad_; }        ///< segments
    std::span<const double> relative_length() const { return relative_length_; }      ///< segments
    std::span<const double> relative_position() const { return relative_position_; }  ///< nodes
    double node_position_m(int node) const { return node_position_m_[node]; }
    bool is_evenly_cut() const { return is_evenly_cut_; }

    /// Where a position lies: in which segment, and at which fraction of it, 0 to 1. One beyond the cable's
    /// ends is taken to be at the end.
    struct Spot {
        int segment = 0;
        double fraction = 0.0;
    };
    Spot spot_at(double position_m) const;
    int nearest_node(double position_m) const;

  private:
    std::vector<double> wrap_angle_rad_;     // segments
    std::vector<double> relative_length_;    // segments
    std::vector<double> relative_position_;  // nodes
    std::vector<double> node_position_m_;    // nodes
    bool is_evenly_cut_;
    double length_m_;
    double axial_stiffness_N_;
    double dynamic_friction_;
    double static_friction_;
    double pretension_N_;
};

}  // namespace capstan
