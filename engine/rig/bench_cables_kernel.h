#pragma once

#include "capstan/effects/bench_effects.h"

namespace capstan {

/// How many benches of one geometry move side by side, a bench in each SIMD lane.
inline constexpr int bench_lanes = 8;

/// One number of each bench.
struct alignas(64) LaneValues {
    double of[bench_lanes] = {};
};

/// A condition for each bench.
struct LaneFlags {
    bool of[bench_lanes] = {};
};

/// The first, and the second of benches that have a pair.
inline constexpr int max_cables = 2;

/// The parameters of a law, a bench in each lane.
template <template <class> class Law>
struct LaneParameters {
    LaneValues of[law_parameters<Law>];
    bool active = false;  ///< in any bench
};

template <class List>
struct LaneParameterSet;
template <template <class> class... Law>
struct LaneParameterSet<LawList<Law...>> : LaneParameters<Law>... {
    void set(int lane, const BenchEffects& effects) { (set_law(lane, effects.of<Law<double>>()), ...); }

    template <template <class> class One>
    bool is_active() const {
        return static_cast<const LaneParameters<One>&>(*this).active;
    }

  private:
    template <template <class> class One>
    void set_law(int lane, const One<double>& law) {
        LaneParameters<One>& parameters = *this;
        const auto values = parameters_of<One>(law);
        for (std::size_t k = 0; k < values.size(); ++k) parameters.of[k].of[lane] = values[k];
        parameters.active |= law.is_active();
    }
};

/// Every effect that is a law of the cable.
using CableLaws = CableLawsOf<BenchEffects>::List;
using CableLawParameters = LaneParameterSet<CableLaws>;

/// One cable of each bench: arrays over nodes, tensions and creep over segments.
struct CableLanes {
    // As the last step left it.
    LaneValues* before_m = nullptr;
    LaneValues* before_bend = nullptr;
    LaneValues* before_speed_m_per_s = nullptr;  ///< mean of the step; only where a drag goes with it
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

/// The pulleys that find their angle.
struct FreePulleys {
    bool motor = true;
    bool load = true;
};

struct CablesGroup {
    int benches = 0;  ///< in the first lanes; nothing reads the others
    int nodes = 0;
    int cables = 0;
    double segment_m = 0.0;
    LaneValues time_step_s;
    CableLawParameters laws;
    LaneValues stretch_m_per_N;  ///< of a segment, by its own elasticity
    LaneValues loss_s;           ///< E72
    LaneValues settled_m;     ///< by how much longer each segment is at rest than under its pretension (E33)
    LaneValues of_neighbour;  ///< how much of its movement the half segment at the load slides by
    LaneValues dynamic_friction;
    LaneValues varying_friction;        ///< not 0: a law of the friction coefficient, or a bend that moves
    bool any_varying_friction = false;  ///< of any bench
    CableLanes cable[max_cables];
    FreePulleys free;  ///< of any bench
};

/// What friction depends on beside the cables themselves.
struct CablesMoment {
    LaneValues load_angle_rad;  ///< for bends that follow it
    LaneValues session_time_s;
    LaneValues settled_m;  ///< of each segment
};

/// Begins a step of these benches where the last one ended.
void begin_cables(const CablesGroup& group, const LaneFlags& active, const CablesMoment& moment);

/// Linearises about the present guess and solves for the conditions of both ends.
void linearise_cables(const CablesGroup& group, const LaneFlags& active, const EndPlaces* motor,
                      const EndPlaces* load, EndTensions* at_motor, EndTensions* at_load);

/// Moves the nodes by `fraction` of the linear solution for these further turns. Returns the largest move of
/// a node [m].
LaneValues move_cables(const CablesGroup& group, const LaneFlags& active, const LaneValues& motor_rad,
                       const LaneValues& load_rad, const LaneValues& fraction);

/// Makes the present guess the step's outcome; writes the tension at both ends of each cable.
void store_cables(const CablesGroup& group, LaneValues* motor_tension_N, LaneValues* load_tension_N);

}  // namespace capstan
