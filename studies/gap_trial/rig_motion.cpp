#include "capstan/gap_trial/rig_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capstan/gap_trial/sensor_chain.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap_trial {

namespace {

constexpr double rig_pause_s = 2.0;
constexpr double hand_bandwidth_Hz = 2.5;

struct Reach {
    double low = -1.0;
    double high = 1.0;
};

// Strokes to changing targets, of changing durations, with rests between some of them; smoothed to what an
// arm or a servo can follow, with a little tremor while it moves. Begins at rest at 0.
std::vector<double> irregular_motion(double duration_s, const Reach& reach, double stroke_s,
                                     TrialStream& draws) {
    const auto count = static_cast<std::size_t>(std::lround(duration_s * fine_rate_Hz)) + 1;
    std::vector<double> values;
    double level = 0.0;
    const auto hold = [&](double time_s) {
        values.insert(values.end(), static_cast<std::size_t>(std::lround(time_s * fine_rate_Hz)), level);
    };
    hold(draws.uniform(0.2, 0.5));
    const double span = reach.high - reach.low;
    while (values.size() < count) {
        double target = draws.uniform(reach.low, reach.high);
        if (std::abs(target - level) < 0.25 * span)
            target += target > 0.5 * (reach.low + reach.high) ? -0.5 * span : 0.5 * span;
        const double takes_s =
            stroke_s * (0.4 + std::abs(target - level) / span) * draws.log_uniform(0.6, 1.8);
        const auto steps = static_cast<int>(std::lround(takes_s * fine_rate_Hz));
        const double skew = draws.uniform(0.8, 1.25);
        const double from = level;
        for (int k = 1; k <= steps; ++k) {
            const double way = std::pow(static_cast<double>(k) / steps, skew);
            values.push_back(from + (target - from) * way * way * (3.0 - 2.0 * way));
        }
        level = target;
        if (draws.integer_below(3) == 0) hold(draws.uniform(0.2, 1.2));
    }
    values.resize(count);
    zero_phase_low_pass(values, hand_bandwidth_Hz, fine_rate_Hz);
    const double first = values.front();
    const double tremor_Hz = draws.uniform(3.0, 6.0);
    const double phase = draws.uniform(0.0, 6.28);
    const std::vector<double> smooth = values;
    for (std::size_t k = 0; k < count; ++k) {
        const double speed =
            k == 0 ? 0.0
                   : std::min(1.0, std::abs(smooth[k] - smooth[k - 1]) * fine_rate_Hz * stroke_s / span);
        const double time_s = static_cast<double>(k) / fine_rate_Hz;
        values[k] = smooth[k] - first +
                    3e-3 * span * speed * std::sin(2.0 * std::numbers::pi * tremor_Hz * time_s + phase);
    }
    return values;
}

TrialRun locked_run_of(const Rig& rig, double duration_s, TrialStream& draws) {
    TrialRun run;
    run.protocol = "locked";
    run.driven = {channel::motor_torque, channel::load_angle};
    const double high_Nm = rig.motor_torque_scale_Nm() * draws.uniform(0.5, 0.85);
    run.motor_torque_Nm = irregular_motion(duration_s, {-high_Nm, high_Nm}, draws.uniform(1.0, 2.0), draws);
    run.load_angle_rad.assign(run.motor_torque_Nm.size(), 0.0);
    return run;
}

// A hand moves the load; the motor renders a virtual spring that saturates, or holds a torque that wanders.
TrialRun handle_run_of(const Rig& rig, double duration_s, TrialStream& draws) {
    TrialRun run;
    run.protocol = "handle";
    run.output = OutputKind::handle;
    run.driven = {channel::motor_torque, channel::load_angle};
    const double reach_rad = draws.uniform(0.2, 0.5);
    run.load_angle_rad =
        irregular_motion(duration_s, {-reach_rad, reach_rad}, draws.uniform(0.6, 1.3), draws);
    const double scale_Nm = rig.motor_torque_scale_Nm();
    if (draws.integer_below(3) > 0) {
        const double most_Nm = scale_Nm * draws.uniform(0.3, 0.7);
        const double spring_Nm_per_rad = most_Nm / reach_rad * draws.uniform(1.0, 3.0);
        for (const double angle_rad : run.load_angle_rad)
            run.motor_torque_Nm.push_back(-most_Nm * std::tanh(spring_Nm_per_rad * angle_rad / most_Nm));
    } else {
        const double most_Nm = scale_Nm * draws.uniform(0.1, 0.4);
        run.motor_torque_Nm = irregular_motion(duration_s, {-most_Nm, most_Nm}, 3.0, draws);
    }
    return run;
}

TrialRun single_run_of(const Rig& rig, double duration_s, TrialStream& draws) {
    TrialRun run;
    run.protocol = "moved";
    run.driven = {channel::motor_angle};
    const NominalBench& nominal = rig.bench.nominal;
    const double slack_rad =
        rig.pretension_N * rig.bench.length_m() / (nominal.axial_stiffness_N * nominal.motor_radius_m);
    const double reach_rad = slack_rad * draws.uniform(0.45, 0.8);
    run.motor_angle_rad =
        irregular_motion(duration_s, {-reach_rad, reach_rad}, draws.uniform(0.5, 1.5), draws);
    return run;
}

TrialRun drive_run_of(double duration_s, double level_Nm, TrialStream& draws) {
    TrialRun run;
    run.protocol = "grip";
    run.driven = {channel::motor_angle, channel::load_torque};
    run.motor_angle_rad =
        irregular_motion(duration_s, {0.0, draws.uniform(0.9, 1.1)}, draws.uniform(0.8, 2.5), draws);
    // The load motor's controller reaches its level within a second and follows it to a few percent.
    const std::vector<double> wander = irregular_motion(duration_s, {-1.0, 1.0}, 2.0, draws);
    const double ripple = draws.uniform(0.01, 0.05);
    for (std::size_t k = 0; k < wander.size(); ++k) {
        const double time_s = static_cast<double>(k) / fine_rate_Hz;
        run.load_torque_Nm.push_back(level_Nm * (1.0 + ripple * wander[k]) *
                                     -std::expm1(-std::pow(time_s / 0.25, 2)));
    }
    return run;
}

}  // namespace

std::vector<TrialRun> draw_rig_session(const Rig& rig, int runs, TrialStream& draws) {
    std::vector<TrialRun> session;
    const double load_sign = draws.sign();
    const int moved = draws.integer_below(runs);
    // Levels of a drive's runs: spread over its range, each somewhere in its part.
    const int first_level = draws.integer_below(runs);
    for (int k = 0; k < runs; ++k) {
        const double duration_s = 0.1 * std::round(draws.uniform(80.0, 130.0));
        if (rig.bench.is_drive()) {
            const double level = ((k + first_level) % runs + draws.uniform(0.1, 0.9)) / runs;
            session.push_back(drive_run_of(duration_s, load_sign * (0.01 + 0.11 * level), draws));
        } else if (!rig.bench.is_pair()) {
            session.push_back(single_run_of(rig, duration_s, draws));
        } else if (k == moved || draws.integer_below(3) > 0) {
            session.push_back(handle_run_of(rig, duration_s, draws));
        } else {
            session.push_back(locked_run_of(rig, duration_s, draws));
        }
        session.back().pretension_N = rig.pretension_N;
    }
    number_runs(session, rig_pause_s);
    return session;
}

}  // namespace capstan::gap_trial
