#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "capstan/cable/cable_state.h"
#include "capstan/solver/end_condition.h"

namespace capstan::paper {

// The paper's Sec. III.B: the closed-form step beside the solvers that it replaces, on the Table I cable with
// 40 N of preload. Sine of the proximal end, 1000 steps a cycle (1 Hz at 1 kHz).

enum class ComparedMotion {
    mass,             ///< 8 cm against a 40 N/m spring to a wall: most steps in mass motion
    partial,          ///< 0.15 cm against that spring: the far end never moves
    monodirectional,  ///< 0.8 cm, distal end locked
    bidirectional,    ///< both ends driven, sines of different period
};
std::string name_of(ComparedMotion motion);

/// Step and generic solver from the same state, over one path.
struct Agreement {
    ComparedMotion motion = ComparedMotion::mass;
    int segments = 0;
    int steps = 0;
    int converged = 0;                  ///< of the generic solver
    double largest_difference_N = 0.0;  ///< over nodes and converged steps
};
/// 1 to 60 segments, every motion.
std::vector<Agreement> compare_with_generic_solver();

/// Another solver of the same step.
struct Peer {
    /// Advances the state in place; returns whether the solver converged.
    using Advance = std::function<bool(CableState&, const EndConditions&)>;

    std::string name;
    std::string title;
    std::function<Advance(const Cable&)> solver_for;
};
Peer linear_assumed_peer();  ///< the paper's own solver: a dense linear system for each assumed pattern
Peer generic_peer();         ///< MINPACK's hybrid root finder

struct SolverRate {
    std::string name;
    std::string title;
    /// Median over rounds; none where a single step took more than a second.
    std::optional<double> steps_per_s{};
    /// How many times as fast the closed-form step was; median over rounds, each of the same moment.
    std::optional<double> closed_form_is_faster_by{};
    double converged_fraction = 1.0;
};

struct RaceSettings {
    ComparedMotion motion = ComparedMotion::mass;
    int segments = 0;
    double seconds_per_solver = 0.0;
};

/// Runs the closed-form step and the peers in turns, in five rounds, so that the machine's other load meets
/// all of them. The closed form goes round the cycle in place; a peer takes its steps in an order that
/// samples the cycle evenly, each from the true state before it. The first rate is the closed form's.
std::vector<SolverRate> race(const RaceSettings& settings, const std::vector<Peer>& peers);

}  // namespace capstan::paper
