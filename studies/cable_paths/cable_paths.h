#pragma once

#include <span>
#include <variant>
#include <vector>

#include "capstan/cable/cable.h"

namespace capstan {

/// The load end does not move.
struct BlockedLoad {};
/// A spring between the load end and a wall. At rest it pulls as the cable does under its pretension.
struct SpringLoad {
    double stiffness_N_per_m = 0.0;
};
/// A constant pull on the load end.
struct WeightLoad {
    double tension_N = 0.0;
};
/// The load end is moved: by how much from its place at rest, positive away from the motor.
struct MovedLoad {
    std::vector<double> displacement_m;  // times
};
using CableLoad = std::variant<BlockedLoad, SpringLoad, WeightLoad, MovedLoad>;

/// The motion of a cable's two ends. Before the first time both rest.
struct CableMotion {
    std::vector<double> motor_m;  // times: how much cable the motor has reeled in; positive pulls
    CableLoad load = BlockedLoad{};
};

/// Numbers of a cable that differ between draws: each list is empty, then every draw has the cable's own
/// number, or has one number for each draw. All lists that are not empty have the same length.
struct CableDraws {
    std::vector<double> friction;           // draws: mu_d; mu_s keeps its ratio to it
    std::vector<double> axial_stiffness_N;  // draws
    std::vector<double> pretension_N;       // draws
};

/// How many draws there are; 1 where all lists are empty.
int count_of(const CableDraws& draws);

/// Everything wrong with the motion and the draws of a cable, by the name of the field.
std::vector<KeyProblem> problems_of(const Cable& cable, const CableMotion& motion, const CableDraws& draws);

/// Where the paths are written: draws x times x nodes.
struct PathArrays {
    std::span<double> tension_N;
    std::span<double> displacement_m;  ///< positive towards the load; 0 at the load end at rest (E2)
};

struct PathReport {
    long long steps = 0;
    long long unverified = 0;  ///< steps whose motion pattern passed no check; the likely one was written
};

/// The tension and displacement at every node over time, for every draw: quasi-static steps in SIMD lanes
/// (E1 to E8), draws side by side on `jobs` threads (0: all processors). A draw's path depends neither on the
/// other draws nor on the number of threads. Throws InvalidInput with problems_of(), before anything is
/// written, and within a StopScope WorkStopped.
PathReport simulate_paths(const Cable& cable, const CableMotion& motion, const CableDraws& draws, int jobs,
                          const PathArrays& paths);

}  // namespace capstan
