#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "capstan/effects/rate_exponents.h"
#include "capstan/estimation/tension_reading.h"
#include "capstan/solver/quasi_static_step.h"

namespace capstan {

/// What is known of both ends at a sample. Where the distal end is not measured, let it stay where it was:
/// the wander then stands for all it does.
struct KnownEnds {
    double proximal_displacement_m = 0.0;
    double distal_displacement_m = 0.0;
};

/// By how much each end moves in one step beyond what is known of it: standard deviations of independent
/// normal increments (E36). They stand for unmeasured motion and for a model that is not quite
/// right.
struct EndWander {
    double proximal_m = 0.0;
    double distal_m = 0.0;
};

struct RecursiveSettings {
    /// States that stand for the posterior: a power of two from 8 to 1024. With 32 the 95% band of a
    /// simulated cycle holds the truth 93 to 95 times of a hundred, with 16 some 91 to 93.
    int members = 32;
    EndWander wander;
    std::uint64_t seed = 1;
    /// Known exactly. Where it is there, mu_s counts as mu_d, as on the bench.
    RateFriction rate_friction{};
    double interval_s = 0.0;  ///< between samples, until set_interval(); needed with rate_friction
};

/// How a step went.
struct RecursiveReport {
    double log_evidence = 0.0;  ///< of this step's readings, given all before (E38)
    int unverified = 0;         ///< members whose closed-form step did not verify
    int slack = 0;              ///< members whose cable carries nothing; readings do not correct those
};

/// The tension everywhere over time, from few readings: the recursive estimator on the feasible curve.
///
/// A member is a state with its friction history. A step moves every member along its own feasible curve
/// (E10, E36), then pulls all of them towards the readings by what the members' spread says of each node
/// (E37, an ensemble Kalman filter without perturbed readings); displacements follow from tensions by E2.
/// What the next step starts from is thus this step's posterior, never the truth. Random numbers are
/// stratified over the members and addressed by (seed, step).
///
/// Friction that depends on speed (E41) is that of the members' mean motion, the same for all of them: an
/// end's wander stands for what is not known of it, and is not a speed at which anything slides.
class RecursiveEstimator {
  public:
    /// Starts with all members at `start`. `model` must outlive the estimator. Throws InvalidInput with every
    /// problem of the settings, if `start` has another number of nodes than the model, or where rate_friction
    /// meets rules other than ElongationRule::mean_tension.
    RecursiveEstimator(const QuasiStaticStep& model, const CableState& start,
                       const RecursiveSettings& settings);

    /// The time between this sample and the next, and all after it; above 0. It matters with rate_friction.
    void set_interval(double interval_s) {
        if (sliding_) sliding_->rates.set_interval(interval_s);
    }

    /// One sample later. Readings may be none. Allocates nothing. Throws InvalidInput if a displacement or a
    /// reading is not a finite number or a sensor sits beyond the cable; the estimate is then unchanged.
    RecursiveReport step(const KnownEnds& ends, std::span<const TensionReading> readings);

    std::span<const double> mean_N() const { return mean_N_; }            ///< nodes: posterior mean
    std::span<const double> deviation_N() const { return deviation_N_; }  ///< nodes: posterior deviation

    struct Moments {
        double mean_N = 0.0;
        double deviation_N = 0.0;
    };
    /// Of the tension at a spot between nodes.
    Moments at(const SensorSpot& spot) const;

  private:
    /// Friction that depends on speed, and what it is worked out with.
    struct Sliding {
        QuasiStaticStep model;  // with the exponents of a trial
        RateExponents rates;    // segments
        std::vector<double> exponent_without_speed;
        std::vector<double> exponent;
        std::vector<CableState> before;  // members
    };

    void move(const KnownEnds& ends, RecursiveReport& report);
    void move_with(const QuasiStaticStep& model, const KnownEnds& ends, RecursiveReport& report);
    void move_sliding(Sliding& sliding, const KnownEnds& ends, RecursiveReport& report);
    void observe(Sliding& sliding) const;
    void correct(const TensionReading& reading, RecursiveReport& report);
    void forbid_pushing();
    void take_moments();

    const QuasiStaticStep& model_;
    RecursiveSettings settings_;
    KnownEnds known_;
    std::uint32_t steps_ = 0;
    std::vector<double> normal_scores_;  // members
    std::vector<CableState> members_;
    std::vector<double*> rows_N_;       // members: their tensions
    std::vector<double*> rows_m_;       // members: their displacements
    std::vector<double> sensed_N_;      // members: tension at the sensor, then its distance from the mean
    std::vector<double> pull_N_;        // members: what a reading asks of the tension at the sensor
    std::vector<double> gain_;          // nodes: tension per tension
    std::vector<double> gain_m_per_N_;  // nodes: displacement per tension, 0 at the proximal end
    std::vector<double> mean_N_;        // nodes
    std::vector<double> deviation_N_;   // nodes
    std::optional<Sliding> sliding_;
};

}  // namespace capstan
