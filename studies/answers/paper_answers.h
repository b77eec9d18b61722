#pragma once
// The paper's experiments beside its own numbers, and a simulated bench.

#include <numbers>
#include <string>
#include <vector>

#include "capstan/bench/bench_run.h"
#include "capstan/paper/error_reduction_tunnel.h"
#include "capstan/paper/pretension_ramps.h"
#include "capstan/paper/ramp_readings.h"
#include "capstan/paper/reading_ablations.h"
#include "capstan/paper/solver_comparison.h"
#include "capstan/paper/viscous_tunnel.h"
#include "capstan/reports/answer.h"

namespace capstan::answers {

inline double degrees(double angle_rad) {
    return angle_rad * 180.0 / std::numbers::pi;
}

/// Exp. 1; `runs`: settings x pretensions, settings as in paper::cable_settings().
reports::Answer exp1_answer(const std::vector<std::vector<paper::RampRun>>& runs,
                            const paper::RampReadings& readings);

/// Every sample of an experiment as CSV.
std::string trajectories_csv(const std::vector<std::vector<paper::RampRun>>& runs);
std::string trajectories_csv(const std::vector<std::vector<paper::TunnelRun>>& runs);

/// Exp. 2 and its Fig. 6; `runs` as for exp1_answer.
reports::Answer exp2_answer(const std::vector<std::vector<paper::TunnelRun>>& runs,
                            const paper::ViscousComparison& viscous);

/// Steps per second of one cable: the closed form, the linear-assumed solver, the generic solver.
struct RatesOfCable {
    int segments = 0;
    std::vector<paper::SolverRate> rates;
};
/// Sec. III.B and Fig. 7.
reports::Answer solver_answer(const std::vector<paper::Agreement>& agreements,
                              const std::vector<RatesOfCable>& rates);

/// Sec. III.C with each reading changed by itself.
reports::Answer paper_estimation_answer(const paper::AblatedTable& table);

/// A simulated bench, collected sample by sample and thinned on the way.
class BenchAnswer {
  public:
    /// `plan` must outlive it.
    explicit BenchAnswer(const bench::BenchPlan& plan);

    void add(const bench::BenchInstant& now);  ///< in the order of time
    reports::Answer finished() const;

  private:
    void add_curves(const bench::BenchInstant& now);
    void add_tensions(const bench::BenchInstant& now);
    void count(const bench::BenchInstant& now);
    std::string headline() const;
    std::string conditions() const;

    const bench::BenchPlan& plan_;
    double ideal_ratio_;
    std::vector<int> drawn_nodes_;
    std::size_t curve_every_;
    std::size_t profile_every_;
    std::size_t snapshot_every_;
    std::size_t sample_ = 0;

    reports::Table angle_, torque_, transfer_, profile_, snapshot_;
    double peak_load_torque_Nm_ = 0.0;
    double peak_motor_torque_Nm_ = 0.0;
    double min_a_N_ = 0.0;
    double min_b_N_ = 0.0;
    std::size_t slack_samples_ = 0;  ///< of either cable
    std::size_t unsolved_ = 0;
};

}  // namespace capstan::answers
