#pragma once

#include <optional>
#include <span>
#include <vector>

#include "capstan/ensemble/cable_belief.h"
#include "capstan/ensemble/cable_rows.h"
#include "capstan/ensemble/ensemble_draws.h"
#include "capstan/ensemble/ensemble_rows.h"
#include "capstan/estimation/tension_reading.h"
#include "capstan/solver/cable_ensemble.h"

namespace capstan {

/// A cable in every member of an ensemble, with the numbers that are not known of it: log friction, log
/// stiffness, log pretension and log wrap of every bend. All arrays are rows of members.
class EnsembleCable {
  public:
    /// Cable `which` of the belief under its pretension, its distal end at 0. `cable` must outlive it; each
    /// cable has draws of its own.
    EnsembleCable(const UncertainCable& cable, const CableBelief& belief, const EnsembleDraws& draws,
                  int which);
    /// Numbers that are drawn for a cable.
    static int drawn_numbers(const UncertainCable& cable) { return 3 + cable.bends(); }

    /// One step. The distal end, or its spring's wall, is at `far_end_m` (members).
    EnsembleReport advance(double proximal_increment_m, std::span<const double> far_end_m);

    /// What a correction may change. Tensions are settled by settle() afterwards.
    void add_tensions(std::vector<double*>& rows);
    void add_numbers(std::vector<double*>& rows);
    /// A spring at the far end counts from the pretension, so a further reading needs the corrected one.
    void take_pretension();
    /// Makes what was corrected a state again: no cable pushes, the numbers count, and displacements follow
    /// from tensions and compliances, back from the far end (E2).
    void settle(std::span<const double> far_end_m);
    /// By how much the proximal end is beyond where the motor has put it (members; 0 where slack).
    void find_off_motor_m(std::span<double> off_m) const;
    /// Moves the distal end (or its spring's wall) and the proximal end by these (members), under a tension
    /// that changes by as much everywhere along the cable.
    void stretch(std::span<const double> far_end_by_m, std::span<const double> proximal_by_m);

    int nodes() const { return members_.nodes(); }
    bool is_slack(int member) const { return members_.is_slack(member); }
    std::span<const double> slack() const { return members_.slack(); }  ///< members: 1 where slack, else 0
    void find_tension_N(const SensorSpot& spot, std::span<double> tension_N) const;  ///< members
    /// The tension of a slack member if a cable could push: negative, the same everywhere (E2).
    double pushing_tension_N(int member, std::span<const double> far_end_m) const;
    /// Where the distal end is while it, or its spring's wall, is at `far_end_m` (both members).
    void find_distal_m(std::span<const double> far_end_m, std::span<double> distal_m) const;
    RowMoments tension_moments_N(int node) const { return moments_of_row(members_.tension_N(node)); }
    RowMoments log_friction() const { return moments_of_row(log_friction_); }

  private:
    double rest_m(std::size_t member) const;
    void take_numbers();
    void add_wrap(int bend, std::span<const double> factor);
    void take_displacements(std::span<const double> far_end_m);
    CableRows rows();

    const UncertainCable& cable_;
    CableEnsemble members_;
    FarEndSupport support_;
    std::optional<RateFrictionStep> rate_step_;
    double moved_m_ = 0.0;  // by the motor since the start
    double nominal_compliance_m_per_N_;
    double nominal_pretension_N_;
    std::vector<double> log_friction_;           // members
    std::vector<double> log_stiffness_;          // members
    std::vector<double> log_pretension_;         // members
    std::vector<std::vector<double>> log_wrap_;  // bends x members
    std::vector<double> friction_;               // members: exp(log_friction_)
    std::vector<double> pretension_N_;           // members
    std::vector<double> distal_value_;           // members
    std::vector<double> workspace_;              // members
    std::vector<double> wrap_rad_;               // segments x members; empty without rate-dependent friction
};

}  // namespace capstan
