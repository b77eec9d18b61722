#pragma once

#include <span>
#include <vector>

#include "capstan/effects/stribeck.h"
#include "capstan/effects/viscous_friction.h"
#include "capstan/solver/cable_ensemble.h"

namespace capstan {

/// Friction that depends on the sliding speed, as the bench has it (E20, E21).
struct RateFriction {
    ViscousFriction viscous{};
    Stribeck stribeck{};

    bool is_active() const { return viscous.is_active() || stribeck.is_active(); }
};

/// Steps an ensemble whose friction depends on speed. A step of CableEnsemble knows friction as an exponent
/// of each segment, so what depends on speed is added to the exponent: Stribeck's part times the wrap, with
/// the low-passed speed of the step before as on the bench, and the viscous drag over the segment's tension
/// (E41). The drag belongs to the speed of the step itself: the step is tried with the last drag, the drag is
/// put right by the speed that comes out, and the step is taken again.
class RateFrictionStep {
  public:
    RateFrictionStep(const RateFriction& friction, const CableEnsemble& members, double segment_m,
                     double interval_s);

    /// One step as CableEnsemble::advance. `wrap_rad`: segments x members. The members' sliding exponents are
    /// as before afterwards.
    EnsembleReport advance(CableEnsemble& members, std::span<const double> wrap_rad,
                           double proximal_increment_m, const CableEnsemble::DistalEnd& distal);

  private:
    void set_exponents(CableEnsemble& members, std::span<const double> wrap_rad) const;
    void observe(const CableEnsemble& members);
    void learn_response();
    void put_drag_right();
    double found_drag_N(std::size_t k) const {
        return drag_N_s_per_m_ * before_.relative_length()[k / count_] * speed_m_per_s_[k];
    }

    // Rows are segments x members.
    RateFriction friction_;
    double interval_s_;
    double drag_N_s_per_m_;                // of a segment of mean length
    std::size_t count_;                    // members
    CableEnsemble before_;                 // as the step found them
    std::vector<double> exponent_;         // without what depends on speed
    std::vector<double> lagging_m_per_s_;  // of the steps before, low-passed
    std::vector<double> speed_m_per_s_;    // in the last trial
    std::vector<double> tension_N_;        // mean of both nodes
    std::vector<double> drag_N_;           // assumed in a trial
    std::vector<double> last_drag_N_;      // assumed in the trial before
    std::vector<double> last_found_N_;     // that the speed of the trial before asked for
    std::vector<double> response_;         // members: how the drag found follows the one assumed
};

}  // namespace capstan
