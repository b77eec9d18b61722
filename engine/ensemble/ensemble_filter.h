#pragma once

#include <array>
#include <span>
#include <vector>

#include "capstan/ensemble/ensemble_cable.h"
#include "capstan/sensing/sensor.h"

namespace capstan {

/// The tension along a cable whose friction, wrap, stiffness, pretension and far end are not known, from what
/// a device has: the motor's position and some sensors.
///
/// An ensemble square-root filter as RecursiveEstimator, but each member is a cable with its own numbers, and
/// the numbers are estimated with the state: log friction, log wrap of every bend, log stiffness, log
/// pretension, the far end's displacement and speed (E40), the zero and gain of every sensor. A reading
/// corrects each of them by its correlation with what the members would read (E58). Displacements follow from
/// tensions and compliances, back from the distal end (E2).
///
/// A member can also be a pull-pull pair between two pulleys (E15): two cables with numbers of their own,
/// whose ends move by as much in opposite directions. They share the far end, and a torque is the difference
/// of their tensions, so that a reading on one cable corrects the other.
class EnsembleFilter {
  public:
    /// `cable` and `draws` must outlive the filter. `sensors` are indices into `offers`, and their ranks
    /// count the draws of zero and gain. Throws InvalidInput where a sensor is beyond the cable.
    EnsembleFilter(const UncertainCable& cable, const CableBelief& belief,
                   std::span<const SensorOffer> offers, std::span<const int> sensors,
                   const EnsembleDraws& draws);

    /// One sample later: the motor has moved the proximal end (of a pair that of cable A) by this, and the
    /// sensors read `readings` [N or m, displacements from the start]. Throws InvalidInput where one is not a
    /// finite number, or after the last sample that has draws.
    void step(double proximal_increment_m, std::span<const double> readings);

    std::span<const double> mean_N() const { return mean_N_; }            ///< cables x nodes
    std::span<const double> deviation_N() const { return deviation_N_; }  ///< cables x nodes

    RowMoments log_friction(int cable = 0) const {
        return cables_[static_cast<std::size_t>(cable)].log_friction();
    }
    RowMoments far_end_m() const { return moments_of_row(far_end_m_); }
    const EnsembleReport& report() const { return report_; }  ///< summed over all steps

  private:
    struct Fitted {
        SensorOffer offer;
        SensorSpot spot;
        std::vector<double> zero;  // members
        std::vector<double> gain;  // members
    };

    void move_far_end();
    std::span<const double> far_end_m(std::size_t cable) const {
        return cable == 0 ? far_end_m_ : opposite_m_;
    }
    /// What the members would read, in `sensed_`, and how far the reading is off their mean.
    struct Innovation {
        double mean = 0.0;
        double off = 0.0;
        double variance = 0.0;  ///< of the members
        double noise_variance = 0.0;
    };
    Innovation innovation(const Fitted& sensor, double reading);
    bool find_pushes(const Fitted& sensor, const Innovation& found);
    void find_tension_N(std::size_t cable, const SensorSpot& spot, std::vector<double>& to) const;
    void sense(const Fitted& sensor);
    void oppose_far_end();
    void hold_motor();
    void correct(Fitted& sensor, double reading);
    void take_moments();

    const EnsembleDraws& draws_;
    std::vector<EnsembleCable> cables_;
    FarEndProcess far_end_;
    bool tells_sum_ = true;         ///< of a pair: a sensor tells of the sum of both tensions
    std::array<bool, 2> pushes_{};  ///< of each cable: slack members read as if they could push
    int sample_ = 0;
    std::vector<double> far_end_m_;        // members
    std::vector<double> far_end_m_per_s_;  // members
    std::vector<double> opposite_m_;       // members: where the far end of cable B is
    std::vector<double> off_m_[2];         // members: of each cable's proximal end
    std::vector<double> far_end_by_m_;     // members
    std::vector<Fitted> sensors_;
    std::vector<double> sensed_;       // members: what each would read, then its distance from their mean
    std::vector<double> workspace_;    // members
    std::vector<double> all_move_;     // members: 1
    std::vector<double> taut_move_;    // members: 1, or 0 for those that are slack
    std::vector<double*> corrected_;   // rows that a reading corrects
    std::vector<double> mean_N_;       // cables x nodes
    std::vector<double> deviation_N_;  // cables x nodes
    EnsembleReport report_;
};

}  // namespace capstan
