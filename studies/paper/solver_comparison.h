#pragma once

#include <optional>
#include <string>
#include <vector>

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

enum class Solver {
    closed_form,
    replicates,  ///< the closed form for 64 replicates at once, strokes within 10%; a step is one replicate's
    band_lu,
    linear_assumed,
    generic,
};
std::string name_of(Solver solver);

struct SolverRate {
    Solver solver = Solver::closed_form;
    /// Median over rounds; nothing where a single step took more than a second.
    std::optional<double> steps_per_s;
    /// How many times as fast the closed-form step was; median over rounds, each of the same moment.
    std::optional<double> closed_form_is_faster_by;
    double converged_fraction = 1.0;
};

struct RaceSettings {
    ComparedMotion motion = ComparedMotion::mass;
    int segments = 0;
    double seconds_per_solver = 0.0;
};

/// Runs the solvers in turns, in five rounds, so that what else the machine does meets all of them. The step
/// goes round the cycle in place; a peer takes its steps in an order that samples the cycle evenly, each from
/// the true state before it.
std::vector<SolverRate> race(const RaceSettings& settings, const std::vector<Solver>& solvers);

/// The slowest step of a cycle in mass motion [s], after one cycle to warm up: of every step the fastest of
/// three cycles, so that a step is not blamed for what interrupted it.
double slowest_step_s(int segments);

/// The least that a step in mass motion of such a cable can take here [s]: only writing a state from two
/// tables, with no check; what the memory allows.
double bare_write_s(int segments);

}  // namespace capstan::paper
