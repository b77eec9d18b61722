#pragma once

#include <string>

#include "capstan/solver/quasi_static_step.h"

namespace capstan::fuzz {

/// Finite numbers, no compression, as many nodes as the cable has: of every state, verified or not.
void demand_a_state(const Cable& cable, const CableState& state);

/// Laws that bind one verified answer to the next, void from the first that is not verified until the cable
/// is slack, which erases all history.
class VerifiedAnswers {
  public:
    explicit VerifiedAnswers(const QuasiStaticStep& step) : step_(step) {}

    /// The ends have what was prescribed, no segment holds more than static friction can, and under the
    /// consistent rules every taut segment is as long as its tensions say.
    void demand_of(const StepReport& report, const CableState& state, const EndConditions& ends);

    void restart() { unbroken_ = true; }

  private:
    void demand_ends(const CableState& state, const EndConditions& ends) const;
    void demand_segments(const CableState& state) const;

    const QuasiStaticStep& step_;
    bool unbroken_ = true;
    /// Nodes at rest keep the rounding of the largest values that they have had.
    double largest_tension_N_ = 0.0;
    double largest_displacement_m_ = 0.0;
    double rounding_N_ = 0.0;
    double rounding_m_ = 0.0;
};

/// Bit for bit; the tool for "state is then unchanged".
void demand_unchanged(const CableState& before, const CableState& after);

/// `thrown` must have all of `words`.
void demand_words(const std::string& thrown, const std::string& words);

}  // namespace capstan::fuzz
