#pragma once

#include <array>
#include <span>
#include <vector>

#include "capstan/rig/bench_cables.h"
#include "capstan/rig/bench_pulleys.h"

namespace capstan {

/// A bench as it is built: one cable with its far end held, or two between pulleys (E15).
struct BenchDescription {
    Cable cable;  ///< each of the pair
    CableArrangement arrangement = CableArrangement::pull_pull;
    Pulleys pulleys{};
    Inertia inertia{};  ///< known ones; an effect's inertia comes on top
    TorqueZeros zeros{};
    CableEnds ends{};
    /// Losses in the cables' material (E72) [s]: tension follows strain + loss * rate of strain.
    double cable_loss_s = 0.0;
};

struct BenchReport {
    bool converged = true;
    int iterations = 0;
};

/// Up to bench_lanes benches of one geometry, each with its own inputs, numbers and effects: a SIMD lane
/// each. What a bench does never depends on its neighbours.
///
/// Node displacements and the free pulley angles solve equilibrium by Newton's method: one tridiagonal system
/// a cable (BenchCables), bordered by the pulleys' torque balances (BenchPulleys). Friction has bristles
/// (E22), by default so stiff that a bench without effects agrees with PullPull to the discretisation. 2 to 4
/// iterations a step, O(nodes).
class BenchSimulations {
  public:
    /// 1 to bench_lanes of each; cable length and segments of the first are everybody's. At rest under the
    /// pretension. Throws InvalidInput if a radius is not positive or a cable's segments are not
    /// equal.
    BenchSimulations(std::span<const BenchDescription> descriptions, std::span<const BenchEffects> effects);

    int count() const { return count_; }

    /// `inputs`: of each bench, with one time step. Throws InvalidInput if there are more or fewer of them
    /// than benches, if those of a bench determine no motion or are not finite, or if the time steps differ;
    /// nothing has moved then.
    std::array<BenchReport, bench_lanes> advance(std::span<const BenchInputs> inputs);
    /// All benches by the same inputs.
    std::array<BenchReport, bench_lanes> advance(const BenchInputs& inputs);
    /// The bench moves no further; its reports say that it does not converge.
    void stop(int bench) { stopped_.of[bench] = true; }

    const BenchPulleys& pulleys(int bench) const { return pulleys_[static_cast<std::size_t>(bench)]; }
    /// 0: cable A, 1: cable B.
    double tension_at_N(int bench, int cable, double position_m) const {
        return cables_.tension_at_N(cable, bench, position_m);
    }
    const BenchCables& cables() const { return cables_; }

  private:
    using EachAngles = std::array<PulleyAngles, bench_lanes>;
    using EachReport = std::array<BenchReport, bench_lanes>;
    using EachInputs = std::span<const BenchInputs>;
    struct Free {
        LaneFlags motor;
        LaneFlags load;
    };
    /// The cables' pull on both pulleys, linear in their further turns.
    struct Pull {
        EndTensions motor;
        EndTensions load;
    };

    void begin(EachInputs inputs, const LaneFlags& active);
    /// What the motor pulley of a bench has reeled in, and its radius, which follow from its angle.
    struct Reel {
        double angle_rad = 0.0;
        double reeled_m = 0.0;
        double radius_m = 0.0;
    };
    const Reel& reel(std::size_t bench, double motor_rad);
    Pull linearise(const LaneFlags& active, const EachAngles& angles);
    void iterate(EachInputs inputs, const Free& free, LaneFlags active, EachAngles& angles,
                 EachReport& reports);
    void solve(EachInputs inputs, const Free& free, int lane, PulleyAngles from, EachAngles& angles,
               EachReport& reports);
    void bracket(EachInputs inputs, const Free& free, int lane, PulleyAngles from, EachAngles& angles,
                 EachReport& reports);

    int count_;
    LaneFlags stopped_;
    std::vector<Pulleys> radii_;
    std::vector<BenchEffects> effects_;
    std::vector<double> motor_rest_m_;
    // Where the pulleys put the cables' ends in the present guess.
    EndPlaces motor_places_[max_cables];
    EndPlaces load_places_[max_cables];
    std::vector<Reel> reels_;  // at the last angle: one that is given stays through a step
    BenchCables cables_;
    std::vector<BenchPulleys> pulleys_;
};

/// One bench over time, with the effects that the ideal model leaves out.
class BenchSimulation {
  public:
    BenchSimulation(const BenchDescription& description, const BenchEffects& effects)
        : benches_({&description, 1}, {&effects, 1}) {}

    BenchReport advance(const BenchInputs& inputs) { return benches_.advance(inputs)[0]; }

    /// What the encoders and torque cells of an ideal bench would read.
    double motor_angle_rad() const { return benches_.pulleys(0).motor_angle_rad(); }
    double load_angle_rad() const { return benches_.pulleys(0).load_angle_rad(); }
    double motor_torque_Nm() const { return benches_.pulleys(0).motor_torque_Nm(); }
    double load_torque_Nm() const { return benches_.pulleys(0).load_torque_Nm(); }
    /// 0: cable A, 1: cable B.
    double tension_at_N(int cable, double position_m) const {
        return benches_.tension_at_N(0, cable, position_m);
    }
    /// Of a cable's node, positive towards the load end.
    double displacement_m(int cable, int node) const {
        return benches_.cables().displacement_m(cable, 0, node);
    }
    /// At the pulleys.
    double motor_tension_N(int cable) const { return benches_.cables().motor_tension_N(cable, 0); }
    double load_tension_N(int cable) const { return benches_.cables().load_tension_N(cable, 0); }

  private:
    BenchSimulations benches_;
};

}  // namespace capstan
