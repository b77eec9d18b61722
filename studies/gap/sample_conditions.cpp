#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include "capstan/gap/gap_map.h"
#include "capstan/recording/channel_range.h"
#include "capstan/rig/channel_names.h"

namespace capstan::gap {

namespace {

// The angle that shows how a run moves: the handle's where it is moved, else the motor's.
const std::vector<double>* moving_angle(const Recording& recording, const RecordedRun& run) {
    constexpr double moves_rad = 0.02;
    for (const char* name : {channel::load_angle, channel::motor_angle}) {
        const auto channel = recording.channel(name);
        if (!channel) continue;
        const std::vector<double>& angle = run.values[static_cast<std::size_t>(*channel)];
        if (range_of(angle).span() > moves_rad) return &angle;
    }
    return nullptr;
}

// Slope over a tenth of a second around each sample.
std::vector<double> speed_of(const Recording& recording, const RecordedRun& run) {
    const std::vector<double>* angle = moving_angle(recording, run);
    std::vector<double> speed(static_cast<std::size_t>(run.samples()), 0.0);
    if (angle == nullptr) return speed;
    const int half = std::max(1, static_cast<int>(0.05 * recording.sample_rate_Hz));
    for (int sample = 0; sample < run.samples(); ++sample) {
        const auto from = static_cast<std::size_t>(std::max(0, sample - half));
        const auto to = static_cast<std::size_t>(std::min(run.samples() - 1, sample + half));
        if (to == from) continue;
        speed[static_cast<std::size_t>(sample)] =
            ((*angle)[to] - (*angle)[from]) / (run.time_s[to] - run.time_s[from]);
    }
    return speed;
}

using PerRun = std::vector<std::vector<double>>;  // runs x samples

// Below this fraction of the largest speed the bench counts as at rest.
constexpr double rest_fraction = 0.03;

struct RecordedMotion {
    PerRun speed;             // 0 at rest
    PerRun since_reversal_s;  // infinite before the first
};

RecordedMotion motion_of(const Recording& recording) {
    RecordedMotion motion;
    for (const RecordedRun& run : recording.runs) {
        std::vector<double> speed = speed_of(recording, run);
        double most = 0.0;
        for (const double value : speed) most = std::max(most, std::abs(value));
        for (double& value : speed) value = std::abs(value) < rest_fraction * most ? 0.0 : value;
        std::vector<double> since(speed.size(), std::numeric_limits<double>::infinity());
        double last_way = 0.0;
        std::optional<double> reversed_s;
        for (std::size_t sample = 0; sample < speed.size(); ++sample) {
            if (speed[sample] * last_way < 0.0) reversed_s = run.time_s[sample];
            if (speed[sample] != 0.0) last_way = speed[sample];
            if (reversed_s) since[sample] = run.time_s[sample] - *reversed_s;
        }
        motion.speed.push_back(std::move(speed));
        motion.since_reversal_s.push_back(std::move(since));
    }
    return motion;
}

using PartOf = std::function<int(std::size_t run, std::size_t sample)>;

SampleSorting sorted_by(const std::string& by, std::vector<std::string> parts, const Recording& recording,
                        const PartOf& part_of) {
    SampleSorting sorting{by, std::move(parts), {}};
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        std::vector<int> samples;
        for (std::size_t sample = 0; sample < recording.runs[run].time_s.size(); ++sample)
            samples.push_back(part_of(run, sample));
        sorting.part_of.push_back(std::move(samples));
    }
    return sorting;
}

// Three parts with equally many samples.
SampleSorting thirds(const std::string& by, const std::string& unit, const Recording& recording,
                     const PerRun& values, bool skip_zero) {
    std::vector<double> all;
    for (const std::vector<double>& run : values) {
        for (const double value : run) {
            if (!skip_zero || value != 0.0) all.push_back(value);
        }
    }
    if (all.empty()) return {by, {}, {}};
    std::sort(all.begin(), all.end());
    const double low = all[all.size() / 3];
    const double high = all[2 * all.size() / 3];
    return sorted_by(
        by,
        {fmt::format("below {:.3g} {}", low, unit), fmt::format("{:.3g} to {:.3g} {}", low, high, unit),
         fmt::format("above {:.3g} {}", high, unit)},
        recording, [&, low, high](std::size_t run, std::size_t sample) {
            const double value = values[run][sample];
            if (skip_zero && value == 0.0) return -1;
            return value < low ? 0 : value < high ? 1 : 2;
        });
}

PerRun absolute(PerRun values) {
    for (std::vector<double>& run : values) {
        for (double& value : run) value = std::abs(value);
    }
    return values;
}

// The larger tension at the motor, by the torque there.
PerRun motor_tension_N(const Recording& recording) {
    PerRun tension;
    const auto torque = recording.channel(channel::motor_torque);
    for (const RecordedRun& run : recording.runs) {
        std::vector<double> samples(run.time_s.size(), run.pretension_N.value_or(0.0));
        for (std::size_t sample = 0; torque && sample < samples.size(); ++sample) {
            const double pull_N =
                run.values[static_cast<std::size_t>(*torque)][sample] / recording.nominal->motor_radius_m;
            samples[sample] =
                recording.mode == BenchMode::single_cable ? pull_N : samples[sample] + 0.5 * std::abs(pull_N);
        }
        tension.push_back(std::move(samples));
    }
    return tension;
}

}  // namespace

std::vector<SampleSorting> sample_sortings(const Recording& recording,
                                           const std::vector<RunResiduals>& runs) {
    const RecordedMotion motion = motion_of(recording);
    const auto regime = [&](std::size_t run, std::size_t sample) {
        constexpr double nearly_all = 0.95;
        if (motion.speed[run][sample] == 0.0) return 0;
        return runs[run].sliding_fraction[sample] < nearly_all ? 1 : 2;
    };
    const auto direction = [&](std::size_t run, std::size_t sample) {
        const double speed = motion.speed[run][sample];
        return speed == 0.0 ? -1 : speed > 0.0 ? 0 : 1;
    };
    const auto since = [&](std::size_t run, std::size_t sample) {
        const double passed_s = motion.since_reversal_s[run][sample];
        if (std::isinf(passed_s)) return -1;
        return passed_s < 0.1 ? 0 : passed_s < 0.3 ? 1 : passed_s < 1.0 ? 2 : 3;
    };
    PerRun session_s;
    for (const RecordedRun& run : recording.runs) {
        session_s.push_back(run.time_s);
        for (double& time_s : session_s.back()) time_s += run.session_start_s;
    }
    std::vector<SampleSorting> sortings = {
        sorted_by("regime", {"rest", "partial", "mass"}, recording, regime),
        sorted_by("direction", {"forward", "backward"}, recording, direction),
        thirds("speed", "rad/s", recording, absolute(motion.speed), true),
        thirds("tension", "N", recording, motor_tension_N(recording), false),
        sorted_by("since reversal", {"below 0.1 s", "0.1 to 0.3 s", "0.3 to 1 s", "above 1 s"}, recording,
                  since),
        thirds("session", "s", recording, session_s, false)};
    std::erase_if(sortings, [](const SampleSorting& sorting) { return sorting.parts.empty(); });
    for (SampleSorting& sorting : sortings) {
        for (const RunResiduals& run : runs)
            std::fill_n(sorting.part_of[run.run].begin(), run.first_sample, -1);
    }
    return sortings;
}

}  // namespace capstan::gap
