#include "capstan/gap_trial/trial_motion.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "capstan/rig/channel_names.h"

namespace capstan::gap_trial {

namespace {

constexpr double pause_between_runs_s = 2.0;

int fine_samples(double duration_s) {
    return static_cast<int>(std::lround(duration_s * fine_rate_Hz)) + 1;
}

double time_of(std::size_t sample) {
    return static_cast<double>(sample) / fine_rate_Hz;
}

// The minimum-jerk way from 0 to 1 (Flash and Hogan 1985).
double smooth_way(double fraction) {
    const double s = std::clamp(fraction, 0.0, 1.0);
    return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
}

// A level, left at `from_s` and reached after `takes_s`.
struct Move {
    double from_s = 0.0;
    double takes_s = 0.0;
    double level = 0.0;
};

std::vector<double> along(const std::vector<Move>& moves, double duration_s) {
    std::vector<double> values(static_cast<std::size_t>(fine_samples(duration_s)), 0.0);
    for (std::size_t k = 0; k < values.size(); ++k) {
        double level = 0.0;
        for (const Move& move : moves)
            level += (move.level - level) * smooth_way((time_of(k) - move.from_s) / move.takes_s);
        values[k] = level;
    }
    return values;
}

// Torque ramps at 0.1 N m/s between +-0.125 N m, half a second of dwell at each.
std::vector<double> ramps(double duration_s) {
    constexpr double rate_Nm_per_s = 0.1;
    constexpr double highest_Nm = 0.125;
    constexpr double dwell_s = 0.5;
    std::vector<double> values;
    double torque_Nm = 0.0;
    double way = 1.0;
    double dwelt_s = 0.0;
    for (int k = 0; k < fine_samples(duration_s); ++k) {
        values.push_back(torque_Nm);
        const double next_Nm = torque_Nm + way * rate_Nm_per_s / fine_rate_Hz;
        if (std::abs(next_Nm) <= highest_Nm) {
            torque_Nm = next_Nm;
        } else {
            torque_Nm = way * highest_Nm;
            dwelt_s += 1.0 / fine_rate_Hz;
            if (dwelt_s >= dwell_s) {
                way = -way;
                dwelt_s = 0.0;
            }
        }
    }
    return values;
}

// A hand moves the load to and fro: strokes of uneven length and pace, about 40 degrees from end to end.
std::vector<double> hand_motion(double duration_s, TrialStream& draws) {
    std::vector<Move> moves;
    double side = draws.sign();
    for (double time_s = 0.3; time_s < duration_s;) {
        const double takes_s = draws.uniform(0.55, 0.85);
        moves.push_back({time_s, takes_s, side * draws.uniform(0.31, 0.375)});
        time_s += takes_s + draws.uniform(0.0, 0.15);
        side = -side;
    }
    return along(moves, duration_s);
}

// The error-reduction tunnel (E. 7 of the paper): pushes back beyond 0.05 rad, at most 0.2 N m.
double tunnel_torque_Nm(double load_angle_rad) {
    const double beyond_rad = std::max(0.0, std::abs(load_angle_rad) - 0.05);
    return -std::copysign(std::min(0.2, 0.5 * beyond_rad), load_angle_rad);
}

struct Tone {
    double frequency_Hz = 0.0;
    double duration_s = 0.0;
};

// One frequency after the other, each faded in and out.
std::vector<double> tones(const std::vector<Tone>& sequence, double amplitude) {
    constexpr double fade_s = 0.3;
    double duration_s = 0.0;
    for (const Tone& tone : sequence) duration_s += tone.duration_s;
    std::vector<double> values(static_cast<std::size_t>(fine_samples(duration_s)), 0.0);
    double start_s = 0.0;
    for (const Tone& tone : sequence) {
        const double end_s = start_s + tone.duration_s;
        for (std::size_t k = 0; k < values.size(); ++k) {
            const double time_s = time_of(k);
            if (time_s < start_s || time_s > end_s) continue;
            const double envelope =
                smooth_way((time_s - start_s) / fade_s) * smooth_way((end_s - time_s) / fade_s);
            values[k] = amplitude * envelope *
                        std::sin(2.0 * std::numbers::pi * tone.frequency_Hz * (time_s - start_s));
        }
        start_s = end_s;
    }
    return values;
}

std::vector<double> levels(double duration_s, double highest, double every_s, double takes_s,
                           TrialStream& draws) {
    std::vector<Move> moves;
    Move move{0.35, takes_s, 0.0};
    while (move.from_s < duration_s) {
        const double last = move.level;
        move.level = draws.uniform(-highest, highest);
        if (std::abs(move.level - last) < 0.5 * highest)
            move.level = last > 0.0 ? last - highest : last + highest;
        moves.push_back(move);
        move.from_s += every_s;
    }
    return along(moves, duration_s);
}

const std::vector<std::string> driven_pair = {channel::motor_torque, channel::load_angle};

TrialRun locked_run(const std::string& protocol, std::vector<double> torque_Nm, double pretension_N) {
    TrialRun run;
    run.protocol = protocol;
    run.pretension_N = pretension_N;
    run.driven = driven_pair;
    run.load_angle_rad.assign(torque_Nm.size(), 0.0);
    run.motor_torque_Nm = std::move(torque_Nm);
    return run;
}

TrialRun tunnel_run(double duration_s, double pretension_N, TrialStream& draws) {
    TrialRun run;
    run.protocol = "tunnel";
    run.pretension_N = pretension_N;
    run.output = OutputKind::handle;
    run.driven = driven_pair;
    run.load_angle_rad = hand_motion(duration_s, draws);
    for (const double angle_rad : run.load_angle_rad)
        run.motor_torque_Nm.push_back(tunnel_torque_Nm(angle_rad));
    return run;
}

TrialRun sines_run(double pretension_N, TrialStream& draws) {
    TrialRun run;
    run.protocol = "sines";
    run.pretension_N = pretension_N;
    run.output = OutputKind::handle;
    run.driven = driven_pair;
    run.load_angle_rad = tones({{0.25, 4.0}, {0.5, 3.0}, {1.0, 2.5}, {2.0, 2.5}}, draws.uniform(0.11, 0.14));
    const double torque_Nm = draws.sign() * draws.uniform(0.02, 0.045);
    run.motor_torque_Nm = along({{0.0, 0.5, torque_Nm}}, run.duration_s());
    return run;
}

TrialRun single_run(const std::string& protocol, std::vector<double> angle_rad, double pretension_N) {
    TrialRun run;
    run.protocol = protocol;
    run.pretension_N = pretension_N;
    run.driven = {channel::motor_angle};
    run.motor_angle_rad = std::move(angle_rad);
    return run;
}

struct Pretensions {
    double ramp_N = 0.0;
    double moving_N = 0.0;
    double steps_N = 0.0;
};

Pretensions pretensions_of(BenchKind kind) {
    switch (kind) {
        case BenchKind::uniform_tight:
            return {10.0, 10.0, 10.0};
        case BenchKind::uniform_wide:
            return {3.5, 6.0, 3.0};
        case BenchKind::one_bend:
            return {3.2, 6.5, 2.8};
        case BenchKind::single_cable:
            return {25.0, 25.0, 25.0};
        case BenchKind::rig_pair:
        case BenchKind::rig_single:
        case BenchKind::rig_drive:
            break;  // drawn with the rig
    }
    return {};
}

std::vector<TrialRun> pair_session(const TrialBench& bench, TrialStream& draws) {
    const Pretensions pretensions = pretensions_of(bench.kind);
    constexpr double tunnel_s = 16.0;
    const TrialRun tunnel = tunnel_run(tunnel_s, pretensions.moving_N, draws);
    const TrialRun sines = sines_run(pretensions.moving_N, draws);
    // Where friction is so high that ramps do not reach the load, one short ramp comes last.
    if (bench.kind == BenchKind::uniform_tight)
        return {tunnel, sines, locked_run("ramp_locked", ramps(12.0), pretensions.ramp_N)};
    const TrialRun ramp = locked_run("ramp_locked", ramps(30.0), pretensions.ramp_N);
    const TrialRun steps = locked_run(
        "steps_dwell", levels(13.0, 0.115, draws.uniform(1.9, 2.6), 0.13, draws), pretensions.steps_N);
    return {ramp, tunnel, sines, steps};
}

std::vector<TrialRun> single_session(TrialStream& draws) {
    const double pretension_N = pretensions_of(BenchKind::single_cable).moving_N;
    std::vector<Tone> sequence = {{0.25, 4.0}, {0.7, 3.5}, {1.0, 3.5}, {2.0, 3.0}};
    for (std::size_t k = sequence.size(); k > 1; --k)
        std::swap(sequence[k - 1],
                  sequence[static_cast<std::size_t>(draws.integer_below(static_cast<int>(k)))]);
    const double amplitude_rad = draws.uniform(0.36, 0.42);
    return {
        single_run("single_sine", tones(sequence, amplitude_rad), pretension_N),
        single_run("single_steps", levels(14.0, 0.42, draws.uniform(1.5, 2.2), 0.25, draws), pretension_N)};
}

}  // namespace

double TrialRun::duration_s() const {
    const std::size_t samples = std::max(load_angle_rad.size(), motor_angle_rad.size());
    return time_of(samples - 1);
}

std::vector<TrialRun> draw_session(const TrialBench& bench, RecordingLength length, TrialStream& draws) {
    std::vector<TrialRun> runs = bench.is_pair() ? pair_session(bench, draws) : single_session(draws);
    if (length == RecordingLength::brief) {
        const int keep = 1 + draws.integer_below(2);
        while (std::ssize(runs) > keep)
            runs.erase(runs.begin() + draws.integer_below(static_cast<int>(runs.size())));
        // A locked run alone, in which nothing reaches the load, contains too little information.
        const bool only_locked_tight = bench.kind == BenchKind::uniform_tight && runs.size() == 1 &&
                                       runs.front().output == OutputKind::locked;
        if (only_locked_tight) runs = {tunnel_run(16.0, runs.front().pretension_N, draws)};
    }
    number_runs(runs, pause_between_runs_s);
    return runs;
}

void number_runs(std::vector<TrialRun>& runs, double pause_s) {
    double start_s = 0.0;
    for (std::size_t k = 0; k < runs.size(); ++k) {
        runs[k].number = static_cast<int>(k) + 1;
        runs[k].session_start_s = start_s;
        start_s += runs[k].duration_s() + pause_s;
    }
}

}  // namespace capstan::gap_trial
