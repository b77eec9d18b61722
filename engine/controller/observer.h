#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "capstan/estimation/recursive_estimator.h"

namespace capstan {

/// What one reading of an observer is, after that of the motor.
struct ObserverSensor {
    bool is_load_displacement = false;  ///< else the tension at place_m
    double place_m = 0.0;               ///< from the motor
};

struct ObserverSettings {
    double noise_N = 0.0;         ///< standard deviation of a tension reading; above 0
    double load_wander_m = 1e-4;  ///< by how much the load end moves in a sample beyond what is known (E36)
    double motor_wander_m = 0.0;  ///< the same of the motor's end
    int members = 32;             ///< see RecursiveSettings
    std::uint64_t seed = 1;
    /// Friction that depends on the sliding speed (E41), known exactly. With a viscous drag an update moves
    /// the cables twice.
    RateFriction rate_friction{};
};

/// The recursive estimator (E36 to E38) as a control loop meets it: one sample in, the tension at every node
/// with its 95% band out. The motor's position is known, and counts how much cable it has reeled in since the
/// start, positive pulls; the load's displacement, where a sensor has it, is positive away from the motor.
/// Before the first sample the cable was at rest. The ends' wander is that of a sample, so that samples are
/// to come at a constant rate; the sliding speed is taken from their times. An update allocates nothing.
class Observer {
  public:
    /// Starts with the cable at rest under its pretension. Throws InvalidInput with every problem of sensors
    /// and settings.
    Observer(const Cable& cable, std::vector<ObserverSensor> sensors, const ObserverSettings& settings);
    Observer(const Observer&) = delete;
    Observer& operator=(const Observer&) = delete;

    std::size_t readings() const { return 1 + sensors_.size(); }  ///< the motor's, then one of each sensor
    int nodes() const { return step_.cable().nodes(); }
    double time_s() const { return time_s_; }  ///< of the last sample; minus infinity before the first

    /// One sample later. `time_s` above that of the last sample, `readings` as many as readings() and finite;
    /// the caller has checked that. Throws InvalidInput as RecursiveEstimator::step.
    void update(double time_s, std::span<const double> readings);

    /// Mean and limits of the 95% band at every node [N]; each span has nodes() numbers.
    void write_estimate(std::span<double> mean_N, std::span<double> low_N, std::span<double> high_N) const;

    const RecursiveReport& report() const { return report_; }  ///< of the last update

  private:
    QuasiStaticStep step_;
    CableState start_;
    RecursiveEstimator estimator_;
    std::vector<ObserverSensor> sensors_;
    std::vector<TensionReading> tensions_;
    RecursiveReport report_;
    double load_m_ = 0.0;
    double time_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace capstan
