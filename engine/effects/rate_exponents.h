#pragma once

#include <span>
#include <vector>

#include "capstan/effects/stribeck.h"
#include "capstan/effects/viscous_friction.h"

namespace capstan {

/// Friction that depends on the sliding speed, as the bench has it (E20, E21).
struct RateFriction {
    ViscousFriction viscous{};
    Stribeck stribeck{};

    bool is_active() const { return viscous.is_active() || stribeck.is_active(); }
};

/// What the sliding speed adds to the friction exponents of a closed-form step (E41), for cables that are cut
/// alike. Stribeck's part has the low-passed speed of the step before, as on the bench. The viscous drag
/// belongs to the speed of the step itself: the step is tried with the last drag, the drag is put right by
/// the speed that comes out, and the step is taken again. Rows are segments x cables; `k` counts their
/// elements.
class RateExponents {
  public:
    /// `segment_m`: the mean length of a segment; `relative_length`: of each in parts of it.
    RateExponents(const RateFriction& friction, std::span<const double> relative_length, double segment_m,
                  double interval_s, std::size_t cables);

    std::size_t size() const { return drag_N_.size(); }
    /// Above 0: how long the steps from now on are.
    void set_interval(double interval_s) { interval_s_ = interval_s; }
    /// Whether a step has to be taken twice.
    bool needs_second_trial() const { return friction_.viscous.is_active(); }

    /// The state that a trial begins with or ends in: mean tension of both nodes of a segment, and how far
    /// the segment has slid in this step.
    void observe(std::size_t k, double tension_N, double slid_m);

    /// The exponent of a segment that turns by `wrap_rad` and has `exponent` without what depends on speed.
    double with_speed(std::size_t k, double exponent, double wrap_rad) const;

    /// After the first trial.
    void end_first_trial() { put_drag_right(); }
    /// After the last one, which may be the first.
    void end_step();

  private:
    void learn_response();
    void put_drag_right();
    double found_drag_N(std::size_t k) const {
        return drag_N_s_per_m_ * relative_length_[k / cables_] * speed_m_per_s_[k];
    }

    RateFriction friction_;
    double interval_s_;
    double drag_N_s_per_m_;  // of a segment of mean length
    std::size_t cables_;
    std::vector<double> relative_length_;  // segments
    std::vector<double> lagging_m_per_s_;  // of the steps before, low-passed
    std::vector<double> speed_m_per_s_;    // in the last trial
    std::vector<double> tension_N_;        // mean of both nodes
    std::vector<double> drag_N_;           // assumed in a trial
    std::vector<double> last_drag_N_;      // assumed in the trial before
    std::vector<double> last_found_N_;     // that the speed of the trial before asked for
    std::vector<double> response_;         // cables: how the drag found follows the one assumed
};

}  // namespace capstan
