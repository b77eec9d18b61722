#pragma once

#include <vector>

#include "capstan/cable/cable.h"
#include "capstan/effects/bench_effects.h"

namespace capstan {

/// One cable of a bench with effects: what it remembers, and the tensions of the last step.
struct BenchCable {
    std::vector<double> displacement_m;         // nodes
    std::vector<double> bristle;                // nodes: E22
    std::vector<double> lagging_speed_m_per_s;  // nodes: E21
    std::vector<double> creep_m;                // segments: E32
    std::vector<double> tension_N;              // segments
    double motor_tension_N = 0.0;  ///< at the pulley, beyond the friction of the last half segment
    double load_tension_N = 0.0;
};

/// Where a pulley puts a cable's end, and how that follows the pulley: displacement = at + per_rad * (further
/// turn) + compliance * tension.
struct EndPlace {
    double at_m = 0.0;
    double per_rad = 0.0;
    double compliance_m_per_N = 0.0;
};

/// A tension at an end, linear in the further turn of both pulleys.
struct EndTension {
    double value_N = 0.0;
    double per_motor_rad = 0.0;
    double per_load_rad = 0.0;
};

/// Equilibrium of one cable's nodes for given pulley angles, by Newton's method. A node stands for the cable
/// from the middle of one segment to that of the next: tension is constant in a segment and falls across
/// nodes (E1), so t_i - t_{i-1} = z tanh(mu theta / 2) (t_i + t_{i-1}) + drags, z the bristles' bend.
class BenchCableEquations {
  public:
    /// `wrap_angle_rad`: nodes.
    BenchCableEquations(const Cable& cable, std::vector<double> wrap_angle_rad, const BenchEffects& effects);

    /// At rest under `pretension_N`, the load end where its tension lets it, creep at an end.
    BenchCable at_rest(double pretension_N) const;
    /// Where the motor end is then [m].
    double rest_displacement_m(double pretension_N) const;

    /// Begins a step from `before`, with this much wrap added at each node.
    void begin(const BenchCable& before, const std::vector<double>& added_wrap_rad, double time_step_s);

    /// Linearises about the present guess and solves for what both ends ask.
    struct Ends {
        EndTension motor;
        EndTension load;
    };
    Ends linearise(const EndPlace& motor, const EndPlace& load);

    /// Goes on to the solution of the last linearisation for these further turns, times `share`. Returns the
    /// largest move of a node [m].
    double move(double motor_rad, double load_rad, double share);

    /// The step's outcome at the present guess.
    void store(BenchCable& cable);

  private:
    struct InnerEnd {
        double value_N = 0.0;
        double per_end_m = 0.0;    // by the end node's displacement
        double per_inner_m = 0.0;  // by its neighbour's
    };
    void evaluate();
    double crept_m(double pretension_N) const;
    double stretched_m(double pretension_N) const;
    double creep_m(std::size_t segment, double tension_N) const;
    InnerEnd motor_end() const;
    InnerEnd load_end() const;

    const BenchEffects& effects_;
    Presliding bristles_;
    double axial_stiffness_N_;
    double segment_m_;
    double dynamic_friction_;
    std::vector<double> wrap_rad_;     // nodes
    std::vector<double> node_span_m_;  // nodes

    const BenchCable* before_ = nullptr;
    double time_step_s_ = 0.0;
    // The present guess.
    std::vector<double> displacement_m_, friction_, bend_, bend_per_m_;  // nodes
    std::vector<double> tension_N_, tension_per_m_;                      // segments
    // The linear system's solution: moves = value + by_motor * turn + by_load * turn.
    std::vector<double> upper_, value_, by_motor_, by_load_;  // nodes
};

}  // namespace capstan
