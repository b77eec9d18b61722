#include "capstan/paper/ramp_readings.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "capstan/paper/pretension_ramps.h"

namespace capstan::paper {

namespace {

constexpr double table_1_ratio = 5.2;

// Steps of a ramp; tensions follow the torque and not the time, so a loop needs few.
constexpr int ramp_steps = 100;
constexpr int segments = 100;

// A closed loop of load torque over motor torque at one pretension, in parts of the ideal peak. The model has
// no rate and is homogeneous in torque and pretension, so that one loop serves every peak torque and every
// ratio.
struct Loop {
    double peak = 0.0;
    // Errors to the ideal.
    double ramp_square = 0.0;
    double dwell_square = 0.0;
    double ramp_magnitude = 0.0;
    double dwell_magnitude = 0.0;
};

Loop loop_at(double bend_radius_m, double pretension_N) {
    const PullPull bench = paper_bench({"", "", bend_radius_m, {}}, pretension_N, segments);
    constexpr double peak_Nm = 0.125;
    PullPullState state = bench.at_rest();
    PullPullState workspace = state;
    const auto load_at = [&](double fraction) {
        bench.advance(state, {MotorTorque{fraction * peak_Nm}, LoadAngle{0.0}}, workspace);
        return bench.load_torque_Nm(state) / bench.ideal_load_torque_Nm(peak_Nm);
    };
    for (int k = 1; k <= ramp_steps / 2; ++k) load_at(2.0 * k / ramp_steps);
    for (int k = 1; k <= ramp_steps; ++k) load_at(1.0 - 2.0 * k / ramp_steps);
    Loop loop;
    for (int k = 1; k <= ramp_steps; ++k) {  // by symmetry the way back is the same
        const double ideal = -1.0 + 2.0 * k / ramp_steps;
        const double load = load_at(ideal);
        loop.peak = std::max(loop.peak, std::abs(load));
        loop.ramp_square += (ideal - load) * (ideal - load) / ramp_steps;
        loop.ramp_magnitude += std::abs(ideal - load) / ramp_steps;
        loop.dwell_magnitude = std::abs(ideal - load);
    }
    loop.dwell_square = loop.dwell_magnitude * loop.dwell_magnitude;
    return loop;
}

// Loops from low to high pretension for one bend radius.
struct Bend {
    double radius_m = 0.0;
    std::vector<Loop> loops;
};

const std::vector<Bend>& bends() {
    static const std::vector<Bend> all = [] {
        std::vector<Bend> made;
        for (const double radius_m : {0.28, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0, 1.3, 1.7, 2.5, 4.0}) {
            Bend bend{radius_m, {}};
            for (double pretension_N = 0.5; pretension_N < 15.0; pretension_N *= 1.12)
                bend.loops.push_back(loop_at(radius_m, pretension_N));
            made.push_back(std::move(bend));
        }
        return made;
    }();
    return all;
}

double statistic_of(const Loop& loop, const RampReading& reading) {
    const double ramp_s = 2.0 * reading.peak_motor_torque_Nm / slope_Nm_per_s;
    const auto over_time = [&](double ramp, double dwell) {
        return (ramp_s * ramp + dwell_s * dwell) / (ramp_s + dwell_s);
    };
    switch (reading.statistic) {
        case RampStatistic::rms:
            return std::sqrt(over_time(loop.ramp_square, loop.dwell_square));
        case RampStatistic::rms_of_ramps:
            return std::sqrt(loop.ramp_square);
        case RampStatistic::rms_of_dwells:
            return std::sqrt(loop.dwell_square);
        case RampStatistic::mean_magnitude:
            return over_time(loop.ramp_magnitude, loop.dwell_magnitude);
    }
    return 0.0;
}

// The implied peak between which the paper's two rounded numbers leave it.
TorqueRange implied_peak_Nm(const PaperRamp& level) {
    constexpr double half_mNm = 0.0005;
    constexpr double half_percent = 0.005;
    return {(level.rms_of_model_Nm - half_mNm) / (level.fraction_of_peak + half_percent),
            (level.rms_of_model_Nm + half_mNm) / (level.fraction_of_peak - half_percent)};
}

// Interpolated between the loops; nothing where no pretension has that peak.
std::optional<double> at_peak_Nm(const Bend& bend, const RampReading& reading, double peak_Nm) {
    const double peak = peak_Nm / reading.ideal_peak_Nm();
    for (std::size_t k = 1; k < bend.loops.size(); ++k) {
        const Loop& less = bend.loops[k];  // more pretension lets less through
        const Loop& more = bend.loops[k - 1];
        if (!(less.peak <= peak && peak <= more.peak && less.peak < more.peak)) continue;
        const double part = (peak - less.peak) / (more.peak - less.peak);
        return reading.ideal_peak_Nm() *
               ((1.0 - part) * statistic_of(less, reading) + part * statistic_of(more, reading));
    }
    return std::nullopt;
}

ReadAtLevel read_at(const Bend& bend, const RampReading& reading, const PaperRamp& level) {
    constexpr int steps = 10;
    ReadAtLevel read{std::nullopt, level.rms_to_ideal_Nm, level.rms_of_model_Nm};
    const TorqueRange peak = implied_peak_Nm(level);
    for (int k = 0; k <= steps; ++k) {
        const auto rms_Nm = at_peak_Nm(bend, reading, peak.low_Nm + (peak.high_Nm - peak.low_Nm) * k / steps);
        if (!rms_Nm) continue;
        const bool nearer = !read.rms_to_ideal_Nm || std::abs(*rms_Nm - read.paper_Nm) <
                                                         std::abs(*read.rms_to_ideal_Nm - read.paper_Nm);
        if (nearer) read.rms_to_ideal_Nm = rms_Nm;
    }
    return read;
}

double worst_in_tolerances(const ReadingResult& result) {
    double worst = 0.0;
    for (const ReadAtLevel& level : result.levels) {
        if (!level.rms_to_ideal_Nm) return std::numeric_limits<double>::infinity();
        worst = std::max(worst, std::abs(*level.rms_to_ideal_Nm - level.paper_Nm) / level.tolerance_Nm);
    }
    return worst;
}

ReadingResult best_bend(const RampReading& reading) {
    ReadingResult best;
    for (const Bend& bend : bends()) {
        ReadingResult result{reading, bend.radius_m, {}};
        for (const PaperRamp& level : papers_ramps()) result.levels.push_back(read_at(bend, reading, level));
        if (best.levels.empty() || worst_in_tolerances(result) < worst_in_tolerances(best))
            best = std::move(result);
    }
    return best;
}

TorqueRange reproducing_ideal_peaks(RampStatistic statistic) {
    constexpr double step_Nm = 0.005;
    TorqueRange range{std::numeric_limits<double>::infinity(), 0.0};
    for (int k = 60; k <= 140; ++k) {
        const double ideal_Nm = k * step_Nm;
        if (!best_bend({"", ideal_Nm / table_1_ratio, table_1_ratio, statistic}).reproduces_all()) continue;
        range.low_Nm = std::min(range.low_Nm, ideal_Nm);
        range.high_Nm = std::max(range.high_Nm, ideal_Nm);
    }
    return range;
}

}  // namespace

bool ReadAtLevel::reproduced() const {
    return rms_to_ideal_Nm && std::abs(*rms_to_ideal_Nm - paper_Nm) <= tolerance_Nm;
}

bool ReadingResult::reproduces_all() const {
    return std::all_of(levels.begin(), levels.end(),
                       [](const ReadAtLevel& level) { return level.reproduced(); });
}

RampReadings compare_ramp_readings() {
    const RampReading readings[] = {
        {"as printed", 0.125, table_1_ratio, RampStatistic::rms},
        {"as printed, dwells left out", 0.125, table_1_ratio, RampStatistic::rms_of_ramps},
        {"as printed, dwells alone", 0.125, table_1_ratio, RampStatistic::rms_of_dwells},
        {"as printed, mean magnitude instead of rms", 0.125, table_1_ratio, RampStatistic::mean_magnitude},
        {"0.125 N m from peak to peak", 0.0625, table_1_ratio, RampStatistic::rms},
        {"ratio 5 (\"approximately 5\")", 0.125, 5.0, RampStatistic::rms},
        {"ratio 5, dwells left out", 0.125, 5.0, RampStatistic::rms_of_ramps},
        {"ratio 4", 0.125, 4.0, RampStatistic::rms},
        {"peak torque 0.1 N m", 0.1, table_1_ratio, RampStatistic::rms},
        {"peak torque 0.1 N m, ratio 5", 0.1, 5.0, RampStatistic::rms},
    };
    RampReadings all;
    for (const RampReading& reading : readings) all.results.push_back(best_bend(reading));
    all.reproducing = reproducing_ideal_peaks(RampStatistic::rms);
    all.reproducing_without_dwells = reproducing_ideal_peaks(RampStatistic::rms_of_ramps);
    return all;
}

}  // namespace capstan::paper
