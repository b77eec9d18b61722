#pragma once

#include <optional>
#include <span>
#include <vector>

#include "capstan/ensemble/ensemble_draws.h"
#include "capstan/ensemble/ensemble_rows.h"
#include "capstan/ensemble/far_end_process.h"
#include "capstan/ensemble/rate_friction.h"
#include "capstan/ensemble/uncertain_cable.h"
#include "capstan/estimation/tension_reading.h"
#include "capstan/sensing/sensor.h"
#include "capstan/solver/cable_ensemble.h"

namespace capstan {

/// What the distal end is fastened to; what moves as FarEndMotion says is the end itself, or the spring's
/// wall.
struct FarEndSupport {
    double spring_stiffness_N_per_m = 0.0;  ///< 0: the end itself is moved
};

/// What an estimator believes before it has seen a reading.
struct CableBelief {
    CableFactors expected;  ///< log_wrap: of every bend, or empty
    CableUncertainty uncertainty;
    FarEndMotion far_end;
    FarEndSupport support;
    double interval_s = 0.01;  ///< between samples
    /// Known exactly. Where it is there, mu_s counts as mu_d, as on the bench.
    RateFriction rate_friction{};
};

/// The tension along a cable whose friction, wrap, stiffness, pretension and far end are not known, from what
/// a device has: the motor's position and some sensors.
///
/// An ensemble square-root filter as RecursiveEstimator, but each member is a cable with its own numbers, and
/// the numbers are estimated with the state: log friction, log wrap of every bend, log stiffness, log
/// pretension, the far end's displacement and speed (E40), the zero and gain of every sensor. A reading
/// corrects each of them by its correlation with what the members would read (E37). Displacements follow from
/// tensions and compliances, back from the distal end (E2).
class EnsembleFilter {
  public:
    /// `cable` and `draws` must outlive the filter. `sensors` are indices into `offers`, which also count the
    /// draws of zero and gain. Throws InvalidInput where a sensor is beyond the cable.
    EnsembleFilter(const UncertainCable& cable, const CableBelief& belief,
                   std::span<const SensorOffer> offers, std::span<const int> sensors,
                   const EnsembleDraws& draws);

    /// One sample later: the motor has moved the proximal end by this, and the sensors read `readings` [N or
    /// m, displacements from the start]. Throws InvalidInput where one is not a finite number, or after the
    /// last sample that has draws.
    void step(double proximal_increment_m, std::span<const double> readings);

    std::span<const double> mean_N() const { return mean_N_; }            ///< nodes
    std::span<const double> deviation_N() const { return deviation_N_; }  ///< nodes

    RowMoments log_friction() const;
    RowMoments far_end_m() const;
    const EnsembleReport& report() const { return report_; }  ///< summed over all steps

  private:
    struct Fitted {
        SensorOffer offer;
        SensorSpot spot;
        std::vector<double> zero;  // members
        std::vector<double> gain;  // members
    };

    void begin(const CableBelief& belief, std::span<const SensorOffer> offers, std::span<const int> sensors);
    void move_far_end();
    EnsembleReport advance(double proximal_increment_m);
    void correct(Fitted& sensor, double reading);
    void keep_tensions_positive();
    void take_parameters();
    void add_wrap(int bend, std::span<const double> factor);
    void take_displacements();
    void take_moments();
    double distal_tension_N(int member) const { return members_.tension_N(members_.segments())[member]; }
    double sensed(const Fitted& sensor, int member) const;

    const UncertainCable& cable_;
    const EnsembleDraws& draws_;
    CableEnsemble members_;
    FarEndSupport support_;
    FarEndProcess far_end_;
    std::optional<RateFrictionStep> rate_step_;
    double nominal_compliance_m_per_N_;
    double nominal_pretension_N_;
    int sample_ = 0;
    std::vector<double> log_friction_;           // members
    std::vector<double> log_stiffness_;          // members
    std::vector<double> log_pretension_;         // members
    std::vector<std::vector<double>> log_wrap_;  // bends x members
    std::vector<double> wrap_rad_;               // segments x members; empty without rate-dependent friction
    std::vector<double> far_end_m_;              // members
    std::vector<double> far_end_m_per_s_;        // members
    std::vector<Fitted> sensors_;
    std::vector<double> friction_;      // members: exp(log_friction_)
    std::vector<double> pretension_N_;  // members
    std::vector<double> distal_value_;  // members
    std::vector<double> sensed_;        // members: what each would read, then its distance from their mean
    std::vector<double> pull_;          // members
    std::vector<double> tension_pull_;  // members: 0 for those that are slack
    std::vector<double*> corrected_;    // rows that a reading corrects
    std::vector<double> mean_N_;        // nodes
    std::vector<double> deviation_N_;   // nodes
    EnsembleReport report_;
};

}  // namespace capstan
