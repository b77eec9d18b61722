#pragma once

#include <random>

#include "capstan/cable/cable.h"
#include "capstan/solver/quasi_static_step.h"
#include "input_pairs.h"

namespace capstan::test {

/// Both ends wander at random, each step from where the cable is: positions by up to `step_m`, tensions by up
/// to the force that would stretch the complete cable as much, springs by moving their walls and by what is
/// in them. Each end keeps its way for some steps, so that fronts run far into the cable before they turn.
class RandomWalk {
  public:
    RandomWalk(const Cable& cable, const InputPair& pair, double step_m, unsigned seed)
        : pair_(pair),
          step_m_(step_m),
          stiffness_N_per_m_(cable.axial_stiffness_N() / cable.length_m()),
          random_(seed) {}

    EndConditions next(const CableState& state);
    void set_step_m(double step_m) { step_m_ = step_m; }

    /// Uniform between -1 and 1, from the walk's own stream.
    double draw() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }

  private:
    struct Way {
        double drift = 0.0;  // of the step
        int steps_left = 0;
    };
    EndTarget moved(EndTarget target, EndKind kind, Way& way);

    InputPair pair_;
    double step_m_;
    double stiffness_N_per_m_;  // of the complete cable
    Way proximal_;
    Way distal_;
    std::mt19937_64 random_;
};

/// Far enough from slack and from tensions that no cable stands: stretched by 2 to 40 mm.
bool moderately_stretched(const CableState& state);

/// Some state of the cable with a history: both ends thrown about by millimetres from rest.
CableState random_state(const QuasiStaticStep& step, unsigned seed);

/// Changes the tension of each node by a random factor and stretches the cable accordingly (E2): a state that
/// friction does not hold, as where friction has fallen or a measurement has corrected a tension.
void unsettle(CableState& state, const PrefixTables& tables, std::mt19937_64& random);

/// A number of random sign between two powers of ten; in one of ten cases 0.
double random_size(double lowest_exponent, double highest_exponent, std::mt19937_64& random);

}  // namespace capstan::test
