#pragma once

#include "capstan/bench/bench_run.h"
#include "capstan/reports/experiment_page.h"

namespace capstan::cli {

/// A simulated bench as a page, collected sample by sample and thinned on the way.
class BenchPage {
  public:
    explicit BenchPage(const bench::BenchPlan& plan);

    void add(const bench::BenchInstant& now);  // in the order of time
    reports::ExperimentPage finished() const;

  private:
    void add_curves(const bench::BenchInstant& now);
    void add_tensions(const bench::BenchInstant& now);
    void count(const bench::BenchInstant& now);
    std::string verdict() const;
    std::string ways() const;

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
    std::size_t slack_samples_ = 0;  // of either cable
    std::size_t unsolved_ = 0;
};

}  // namespace capstan::cli
