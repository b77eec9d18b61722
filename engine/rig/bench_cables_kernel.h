#pragma once

#include "capstan/rig/bench_lanes.h"

namespace capstan {

/// The first, and the second of benches that have a pair.
inline constexpr int max_cables = 2;

/// The laws of a cable's stretch and friction, a bench a lane; of a step of its length.
struct CableLaws {
    LaneValues stretch_m_per_N;  ///< of a segment, by its own elasticity
    LaneValues creep_fraction;   ///< of the way to its end that creep goes in a step
    LaneValues creep_m_per_N;    ///< of a segment, at creep's end
    LaneValues toe_m;            ///< of a segment: its toe strain (E31)
    LaneValues toe_tension_N;
    LaneValues bristle_m;         ///< E22
    LaneValues bristle_exponent;  ///< 0 or 1 are the common ones
    LaneValues rigid_N_per_m;     ///< E24
    LaneValues viscous_N_per_m2;  ///< E20: drag per length and displacement in this step
    LaneValues dynamic_friction;
    LaneValues stribeck_friction;  ///< E21
    LaneValues stribeck_speed_m_per_s;
    LaneValues stribeck_fraction;  ///< of the way that the lagging speed goes in a step
    LaneValues load_exponent;      ///< E23
    LaneValues load_reference_N_per_m;
    LaneValues varying_friction;  ///< not 0: Stribeck, load dependence or a bend that moves
    // Whether any bench needs this law at all; those that do not keep what they have, bit for bit.
    bool any_creep = false;
    bool any_toe = false;
    bool any_bristle_exponent = false;
    bool any_varying_friction = false;
};

/// One cable of each bench: arrays over nodes, tensions and creep over segments.
struct CableLanes {
    // As the last step left it.
    LaneValues* before_m = nullptr;
    LaneValues* before_bend = nullptr;
    LaneValues* lagging_speed_m_per_s = nullptr;
    LaneValues* crept_m = nullptr;
    LaneValues* before_tension_N = nullptr;
    // Numbers of this step.
    const LaneValues* wrap_rad = nullptr;
    const LaneValues* wrap_per_load_angle = nullptr;
    LaneValues* friction = nullptr;  ///< tanh(mu theta / 2)
    // The present guess.
    LaneValues* displacement_m = nullptr;
    LaneValues* bend = nullptr;
    LaneValues* tension_N = nullptr;
    // The linear system's solution: moves = value + by_motor * turn + by_load * turn.
    LaneValues* upper = nullptr;
    LaneValues* value = nullptr;
    LaneValues* by_motor = nullptr;
    LaneValues* by_load = nullptr;
};

/// Where a pulley puts a cable's end, and how that follows the pulley: displacement = at + per_rad * (further
/// turn) + compliance * tension.
struct EndPlaces {
    LaneValues at_m;
    LaneValues per_rad;
    LaneValues compliance_m_per_N;
};

/// A tension at an end, linear in the further turn of both pulleys.
struct EndTensions {
    LaneValues value_N;
    LaneValues per_motor_rad;
    LaneValues per_load_rad;
};

struct CablesGroup {
    int nodes = 0;
    int cables = 0;
    double segment_m = 0.0;
    double time_step_s = 0.0;
    CableLaws laws;
    CableLanes cable[max_cables];
    bool motor_turns = true;  ///< whether any bench's motor, its load pulley, is to find its angle
    bool load_turns = true;
};

/// Begins a step of these benches at where the last one ended; `load_angle_rad` for bends that follow it.
void begin_cables(const CablesGroup& group, const LaneFlags& active, const LaneValues& load_angle_rad);

/// Linearises about the present guess and solves for what both ends ask.
void linearise_cables(const CablesGroup& group, const LaneFlags& active, const EndPlaces* motor,
                      const EndPlaces* load, EndTensions* at_motor, EndTensions* at_load);

/// Goes on by `share` of the way to the linear solution for these further turns. The largest move of a node
/// [m].
LaneValues move_cables(const CablesGroup& group, const LaneValues& motor_rad, const LaneValues& load_rad,
                       const LaneValues& fraction);

/// Makes the present guess the step's outcome; the tension at either end of each cable [N].
void store_cables(const CablesGroup& group, LaneValues* motor_tension_N, LaneValues* load_tension_N);

}  // namespace capstan
