#include "capstan/paper/pretension_ramps.h"

#include <algorithm>
#include <cmath>

#include "capstan/bench/waveform.h"

namespace capstan::paper {

namespace {

constexpr double highest_torque_Nm = 0.125;
constexpr double duration_s = 30.0;
// Below this the load torque has not changed: rounding is 1e-13 N m, a front that arrives brings 1e-4.
constexpr double unchanged_Nm = 1e-6;

// Motor torque gone through from each reversal until the load notices; only reversals whose ramp is complete.
double dead_width_Nm(const std::vector<RampSample>& samples) {
    double sum_Nm = 0.0;
    int reversals = 0;
    for (std::size_t start = 1; start + 1 < samples.size(); ++start) {
        const double from_Nm = samples[start].motor_torque_Nm;
        const bool dwell_ends =
            samples[start - 1].motor_torque_Nm == from_Nm && samples[start + 1].motor_torque_Nm != from_Nm;
        if (!dwell_ends) continue;
        std::size_t now = start + 1;
        const auto load_unchanged = [&] {
            return std::abs(samples[now].load_torque_Nm - samples[start].load_torque_Nm) <= unchanged_Nm;
        };
        const auto ramp_ended = [&] {
            return samples[now].motor_torque_Nm == samples[now - 1].motor_torque_Nm;
        };
        while (now < samples.size() && load_unchanged() && !ramp_ended()) ++now;
        if (now == samples.size()) break;
        sum_Nm += std::abs(samples[now].motor_torque_Nm - from_Nm);
        ++reversals;
    }
    return reversals > 0 ? sum_Nm / reversals : 0.0;
}

}  // namespace

const std::vector<CableSetting>& cable_settings() {
    static const std::vector<CableSetting> settings = {
        {"table_1",
         "the paper's Table I as it stands: 7.14 rad of wrap (0.28 m over 2 m), 10 N; in Exp. 1 the motion never "
         "reaches the load",
         0.28,
         {10.0}},
        {"reproduces",
         "2.86 rad of wrap (0.70 m over 2 m, as 0.28 m over 0.8 m would have) and lower pretensions, fitted to the "
         "peaks that the paper's rms and fraction-of-peak figures imply",
         0.70,
         {3.0, 3.5, 4.0, 5.0}},
    };
    return settings;
}

PullPull paper_bench(const CableSetting& setting, double pretension_N, int segments) {
    CableSpecification specification;
    specification.curvature = {{2.0, setting.bend_radius_m}};
    specification.segments = segments;
    // Table I's "2 kN/m", read as a force per unit strain as in the estimation experiment. Exp. 1 does not
    // depend on it: it scales every displacement and no tension.
    specification.axial_stiffness_N = 2000.0;
    specification.dynamic_friction = 0.21;
    specification.static_friction = 0.63;
    specification.pretension_N = pretension_N;
    const Cable cable(specification);
    return {cable, cable, {.motor_radius_m = 0.020, .load_radius_m = 0.104}};
}

double ramp_torque_Nm(double time_s) {
    bench::Waveform ramps;
    ramps.kind = bench::WaveformKind::ramps;
    ramps.ramp_amplitude = highest_torque_Nm;
    ramps.slope_per_s = slope_Nm_per_s;
    ramps.dwell_s = dwell_s;
    return ramps.at(time_s);
}

RampRun run_pretension_ramps(const CableSetting& setting, double pretension_N, const Resolution& resolution) {
    const PullPull bench = paper_bench(setting, pretension_N, resolution.segments);
    PullPullState state = bench.at_rest();
    RampRun run;
    run.setting = setting.name;
    run.pretension_N = pretension_N;

    const int steps = static_cast<int>(std::lround(duration_s / resolution.time_step_s));
    double squares = 0.0;
    for (int step = 1; step <= steps; ++step) {
        const double time_s = step * resolution.time_step_s;
        const double torque_Nm = ramp_torque_Nm(time_s);
        const PullPullReport report = bench.advance(state, {MotorTorque{torque_Nm}, LoadAngle{0.0}});
        const RampSample sample{time_s, torque_Nm, state.motor_angle_rad, bench.load_torque_Nm(state),
                                bench.ideal_load_torque_Nm(torque_Nm)};
        run.samples.push_back(sample);
        if (!report.solved()) ++run.unsolved_steps;
        run.peak_load_torque_Nm = std::max(run.peak_load_torque_Nm, std::abs(sample.load_torque_Nm));
        squares += std::pow(sample.load_torque_Nm - sample.ideal_load_torque_Nm, 2);
    }
    run.rms_to_ideal_Nm = std::sqrt(squares / steps);
    run.dead_width_Nm = dead_width_Nm(run.samples);
    run.lost_transfer_ratio = 1.0 - run.peak_load_torque_Nm / bench.ideal_load_torque_Nm(highest_torque_Nm);
    return run;
}

const std::vector<PaperRamp>& papers_ramps() {
    static const std::vector<PaperRamp> ramps = {
        {"low", 0.197, 0.050, 0.20},
        {"med-low", 0.244, 0.010, 0.05},
        {"med-high", 0.271, 0.012, 0.08},
        {"high", 0.322, 0.017, 0.37},
    };
    return ramps;
}

}  // namespace capstan::paper
