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
};

/// The largest friction exponent (mu times total wrap angle) taken: beyond it a tension ratio leaves the
/// range of double precision, and the far end of a real cable feels nothing long before.
inline constexpr double largest_friction_exponent = 300.0;

/// Everything wrong with a specification, by the name of its field; empty if a cable can be made of it.
std::vector<KeyProblem> problems_of(const CableSpecification& specification);

/// A cable cut into segments of equal length; segment i joins nodes i and i + 1, all counted from 0 here
/// (people count from 1), node 0 proximal. A segment's wrap angle is that of the pieces it covers, so the
/// cut loses no bend. Valid when built.
class Cable {
  public:
    /// Throws InvalidInput with every problem of the specification.
    explicit Cable(const CableSpecification& specification);

    int segments() const { return static_cast<int>(wrap_angle_rad_.size()); }
    int nodes() const { return segments() + 1; }
    double length_m() const { return length_m_; }
    double segment_length_m() const { return length_m_ / segments(); }
    /// Elongation of one segment per newton of mean tension [m/N]: dx / EA.
    double segment_compliance_m_per_N() const { return segment_length_m() / axial_stiffness_N_; }
    double axial_stiffness_N() const { return axial_stiffness_N_; }
    double dynamic_friction() const { return dynamic_friction_; }
    double static_friction() const { return static_friction_; }
    double pretension_N() const { return pretension_N_; }
    std::span<const double> wrap_angle_rad() const { return wrap_angle_rad_; }  ///< segments
    double node_position_m(int node) const { return node * segment_length_m(); }

  private:
    std::vector<double> wrap_angle_rad_;  // segments
    double length_m_;
    double axial_stiffness_N_;
    double dynamic_friction_;
    double static_friction_;
    double pretension_N_;
};

}  // namespace capstan
