#pragma once

#include <span>
#include <vector>

#include "capstan/cable/cable.h"
#include "capstan/effects/bench_effects.h"
#include "capstan/rig/bench_cables_kernel.h"

namespace capstan {

/// How well the place of a cable's end is known where an encoder reads it, as a rule [m].
inline constexpr double usual_end_error_m = 3e-6;

/// What is known of the places of a cable's ends.
struct CableEnds {
    /// The load never turns. Cable slides up to it all the same, as the middle of the last half segment does.
    bool load_is_held = false;
    /// How well the places are known [m]. A turn of an end by less may be none, so that friction builds up
    /// over this length at least (E22). 0: exactly.
    double error_m = usual_end_error_m;
};

/// The cables of up to bench_lanes benches that differ in their numbers: one each, or a pair.
///
/// A node stands for the cable from the middle of one segment to that of the next: tension is constant in a
/// segment and falls across nodes (E1), so t_i - t_{i-1} = z tanh(mu theta / 2) (t_i + t_{i-1}) + drags, z
/// the bristles' bend. Newton's method on the nodes' displacements, a tridiagonal system each.
class BenchCables {
  public:
    /// `cables`: one of each bench, all with the same length and as many equal segments; throws InvalidInput
    /// where they are not equal. `losses_s` (E72), `ends`: of each bench. At rest under its pretension, the
    /// load end where its tension lets it, creep at an end.
    BenchCables(std::span<const Cable> cables, std::span<const double> losses_s,
                std::span<const BenchEffects> effects, std::span<const CableEnds> ends,
                CableArrangement arrangement);
    BenchCables(const BenchCables&) = delete;
    BenchCables& operator=(const BenchCables&) = delete;

    /// Where a cable's motor end rests under its pretension [m].
    double rest_displacement_m(int bench) const;
    /// By how much each segment is longer at rest when only this part of the pretension is left [m] (E33).
    double settled_m(int bench, double kept) const;

    void begin(const LaneFlags& active, const CablesMoment& moment, const LaneValues& time_step_s);
    /// The pulleys that find their angle in any bench; the turns of the others are not solved for.
    void set_free(const FreePulleys& free) { group_.free = free; }

    struct Ends {
        EndTensions motor[max_cables];
        EndTensions load[max_cables];
    };
    Ends linearise(const LaneFlags& active, const EndPlaces (&motor)[max_cables],
                   const EndPlaces (&load)[max_cables]);
    LaneValues move(const LaneFlags& active, const LaneValues& motor_rad, const LaneValues& load_rad,
                    const LaneValues& fraction);
    /// Makes the present guess the step's outcome.
    void store();

    int count() const { return group_.cables; }
    /// At the pulley, beyond the friction of the last half segment.
    double motor_tension_N(int cable, int bench) const { return motor_tension_N_[cable].of[bench]; }
    double load_tension_N(int cable, int bench) const { return load_tension_N_[cable].of[bench]; }
    /// Fraction of a bench's nodes whose friction is fully built up: 1 in mass motion.
    double sliding_fraction(int bench) const;
    /// Positive towards the load end.
    double displacement_m(int cable, int bench, int node) const {
        return arrays_[cable].before_m[static_cast<std::size_t>(node)].of[bench];
    }
    /// Between the segments' middles, where a segment's tension stands.
    double tension_at_N(int cable, int bench, double position_m) const;

  private:
    using PerNode = std::vector<LaneValues>;
    struct Arrays {
        PerNode before_m, before_bend, before_speed_m_per_s, lagging_speed_m_per_s, crept_m, before_tension_N,
            wrap_rad, wrap_per_load_angle, friction, displacement_m, bend, tension_N, upper, value, by_motor,
            by_load;
    };
    /// What stretches one bench's cable at rest.
    struct Rest {
        double axial_stiffness_N = 0.0;
        Creep creep;
        NonlinearStiffness toe;
        double load_compliance_m_per_N = 0.0;
        double motor_compliance_m_per_N = 0.0;
        double pretension_N = 0.0;
    };
    void set_laws(int lane, const Cable& cable, const BenchEffects& effects, const CableEnds& ends);
    void set_rest(int lane, const Cable& cable, const BenchEffects& effects);
    double crept_m(const Rest& rest, double tension_N) const;
    double elastic_m(const Rest& rest, double tension_N) const;
    double stretched_m(const Rest& rest, double tension_N) const;

    CablesGroup group_;  // refers to the arrays
    Rest rest_[bench_lanes];
    Arrays arrays_[max_cables];
    LaneValues motor_tension_N_[max_cables];
    LaneValues load_tension_N_[max_cables];
};

}  // namespace capstan
