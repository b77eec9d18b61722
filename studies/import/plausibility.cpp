#include "capstan/import/plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "capstan/cable/invalid_input.h"
#include "capstan/calibration/twin.h"
#include "capstan/import/units.h"
#include "capstan/platform/statistics.h"
#include "capstan/recording/channel_range.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/rig/channel_names.h"

namespace capstan::imports {

namespace {

constexpr std::size_t compared_runs = 3;
constexpr std::size_t compared_samples = 600;  // of a run
constexpr int compared_segments = 20;
constexpr int modelled_segments = 100;  // with more, friction at rest changes by less than 1%
// Parts of a channel's variance that the model leaves.
constexpr double not_explained = 0.5;  // with more, a channel is not explained
constexpr double explaining_gain =
    0.4;  // and a correction that explains it takes this much of the sum over channels
constexpr double looked_into = 0.1;  // with less, no correction is tried
constexpr double max_left = 0.2;     // of the sum over channels, by a correction that explains none anew
constexpr double guessed = 0.34;     // with more after all corrections, these are called guesses
constexpr int max_corrections = 3;

/// A channel's numbers times a factor, or two channels exchanged.
struct Correction {
    std::size_t channel = 0;
    std::optional<std::size_t> exchanged_with{};
    double factor = 1.0;
    std::string unit{};  ///< that the numbers would be in; empty: the sign alone
};

std::vector<Correction> corrections_of(const Recording& recording) {
    std::vector<Correction> all;
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        const std::string& unit = recording.channels[channel].unit;
        all.push_back({channel, {}, -1.0, ""});
        std::vector<std::string> units;
        if (unit == "rad") units = {"deg", "turn", "mrad"};
        if (unit == "N m") units = {"mN m", "N cm", "ozf in", "kgf cm"};
        if (unit == "N") units = {"g", "kg", "mN", "kN", "lbf"};
        if (unit == "m") units = {"mm", "cm", "in"};
        for (const std::string& other : units) {
            const double si = find_unit(other)->si;
            for (const double sign : {1.0, -1.0}) {
                all.push_back({channel, {}, sign * si, other});
                all.push_back(
                    {channel, {}, sign / si, unit});  // converted although they were in SI units already
            }
        }
        for (std::size_t other = channel + 1;
             largest_span(recording, channel) > 0.0 && other < recording.channels.size(); ++other) {
            if (largest_span(recording, other) > 0.0) all.push_back({channel, other, 1.0, ""});
        }
    }
    return all;
}

// A few samples of the first runs, for many simulations.
Recording thinned(const Recording& recording) {
    Recording thin = recording;
    thin.runs.clear();
    for (const RecordedRun& run : recording.runs) {
        if (thin.runs.size() == compared_runs) break;
        RecordedRun kept = run;
        const std::size_t every = std::max<std::size_t>(1, run.time_s.size() / compared_samples);
        const auto pick = [&](const std::vector<double>& values) {
            std::vector<double> some;
            for (std::size_t k = 0; k < values.size(); k += every) some.push_back(values[k]);
            return some;
        };
        kept.time_s = pick(run.time_s);
        for (auto& values : kept.values) values = pick(values);
        if (kept.time_s.size() >= min_run_samples) thin.runs.push_back(std::move(kept));
    }
    return thin;
}

Recording corrected(Recording recording, const Correction& correction) {
    for (RecordedRun& run : recording.runs) {
        for (double& value : run.values[correction.channel]) value *= correction.factor;
        if (correction.exchanged_with)
            std::swap(run.values[correction.channel], run.values[*correction.exchanged_with]);
    }
    return recording;
}

double variation(const std::vector<double>& values) {
    const double mean = mean_of(values);
    double sum = 0.0;
    for (const double value : values) sum += (value - mean) * (value - mean);
    return sum;
}

/// The part of each channel's variance that the nominal model leaves, 0 to 1; nothing for what it does not
/// predict.
class ModelFit {
  public:
    explicit ModelFit(const Recording& recording) : left_(recording.channels.size()) {
        const auto twin = gap::make_twin(recording, compared_segments);
        const std::vector<double> nominal = gap::nominal_values(*twin);
        std::vector<double> squares(recording.channels.size(), 0.0);
        std::vector<double> sizes(recording.channels.size(), 0.0);
        for (std::size_t run = 0; run < recording.runs.size(); ++run) {
            const gap::TwinRun modelled = twin->run(run, nominal);
            for (std::size_t channel = 0; channel < left_.size(); ++channel) {
                const std::vector<double>& measured = recording.runs[run].values[channel];
                const std::vector<double>& model = modelled.values[channel];
                if (model.empty()) continue;
                std::vector<double> rest(measured.size());
                for (std::size_t k = 0; k < rest.size(); ++k) rest[k] = measured[k] - model[k];
                squares[channel] += variation(rest);
                sizes[channel] += variation(measured);
            }
        }
        for (std::size_t channel = 0; channel < left_.size(); ++channel) {
            if (sizes[channel] > 0.0 && std::isfinite(squares[channel]))
                left_[channel] = std::min(1.0, squares[channel] / sizes[channel]);
        }
    }

    double total() const {
        double sum = 0.0;
        for (const auto& left : left_) sum += left.value_or(0.0);
        return sum;
    }
    /// How many channels are not explained.
    int unexplained() const {
        return static_cast<int>(std::count_if(
            left_.begin(), left_.end(), [](const auto& left) { return left && *left > not_explained; }));
    }
    double worst() const {
        double worst = 0.0;
        for (const auto& left : left_) worst = std::max(worst, left.value_or(0.0));
        return worst;
    }

  private:
    std::vector<std::optional<double>> left_;
};

std::optional<ModelFit> fit_of(const Recording& recording) {
    try {
        return ModelFit(recording);
    } catch (const InvalidInput&) {  // a correction may leave no motion
        return std::nullopt;
    }
}

Finding named(const Recording& recording, const Correction& correction, const ModelFit& before,
              const ModelFit& after) {
    const std::string& name = recording.channels[correction.channel].name;
    const std::string gain = fmt::format(
        "the nominal model leaves {:.0f}% of a channel's variance unexplained now and {:.0f}% with it",
        100.0 * before.worst(), 100.0 * after.worst());
    if (correction.exchanged_with) {
        const std::string& other = recording.channels[*correction.exchanged_with].name;
        return {.kind = FindingKind::swapped_channels,
                .channel = name,
                .words = fmt::format("{} and {} look exchanged: {}. Exchange their columns in the mapping",
                                     name, other, gain)};
    }
    if (correction.unit.empty())
        return {.kind = FindingKind::wrong_sign,
                .channel = name,
                .amount = -1.0,
                .words =
                    fmt::format("the sign of {} looks wrong: {}. State sign = -1 (or 1) for it", name, gain)};
    return {.kind = FindingKind::wrong_unit,
            .channel = name,
            .amount = correction.factor,
            .words = fmt::format(
                "the unit of {} looks wrong: its numbers look like {}{}: {}. Correct its `unit`{}", name,
                correction.unit, correction.factor < 0.0 ? " with the other sign" : "", gain,
                correction.factor < 0.0 ? " and its `sign`" : "")};
}

std::vector<Finding> doubts_by_model(const Recording& recording) {
    std::vector<Finding> found;
    Recording now = thinned(recording);
    if (now.runs.empty()) return found;
    std::optional<ModelFit> fit = fit_of(now);
    const std::vector<Correction> corrections = corrections_of(recording);
    for (int round = 0; round < max_corrections && fit && fit->worst() > looked_into; ++round) {
        std::optional<ModelFit> best;
        const Correction* chosen = nullptr;
        for (const Correction& correction : corrections) {
            const std::optional<ModelFit> after = fit_of(corrected(now, correction));
            if (after && (!best || after->total() < best->total() - 1e-9)) {
                best = after;
                chosen = &correction;
            }
        }
        if (!best) break;
        // One correction has to explain a channel that was not explained before, or most of what is left of
        // all.
        const bool explains =
            best->unexplained() < fit->unexplained() && fit->total() - best->total() > explaining_gain;
        if (!explains && best->total() > max_left * fit->total()) break;
        found.push_back(named(now, *chosen, *fit, *best));
        now = corrected(now, *chosen);
        fit = best;
    }
    // Corrections that leave the rest unexplained are guesses; a real gap may be behind it.
    if (fit && !found.empty() && fit->worst() > guessed) {
        for (Finding& finding : found)
            finding.words += fmt::format("; even so {:.0f}% of a channel is left, so this is a guess",
                                         100.0 * fit->worst());
    }
    return found;
}

struct Work {
    double motor_J = 0.0;
    double load_J = 0.0;
    double motor_path_Nm_rad = 0.0;  ///< spans of torque times angle
    double load_path_Nm_rad = 0.0;
};

double work_of(const std::vector<double>& torque, const std::vector<double>& angle) {
    double sum = 0.0;
    for (std::size_t k = 1; k < angle.size(); ++k)
        sum += 0.5 * (torque[k] + torque[k - 1]) * (angle[k] - angle[k - 1]);
    return sum;
}

/// Closed loops only: from where an angle starts to the last sample near that angle.
std::size_t loop_end(const std::vector<double>& angle) {
    const double near = 0.02 * range_of(angle).span();
    for (std::size_t k = angle.size(); k-- > angle.size() / 2;) {
        if (std::abs(angle[k] - angle[0]) <= near) return k + 1;
    }
    return angle.size();
}

std::vector<Finding> doubts_by_work(const Recording& recording) {
    std::vector<std::size_t> at;
    for (const char* name : channel::all) {
        const auto index = recording.channel(name);
        if (!index) return {};
        at.push_back(static_cast<std::size_t>(*index));
    }
    Work work;
    double angle_span = 0.0;
    for (const RecordedRun& run : recording.runs) {
        std::vector<std::vector<double>>
            values;  // in the order of channel::all: angle, torque, angle, torque
        const std::size_t end = loop_end(run.values[at[0]]);
        for (const std::size_t index : at)
            values.emplace_back(run.values[index].begin(),
                                run.values[index].begin() + static_cast<std::ptrdiff_t>(end));
        work.motor_J += work_of(values[1], values[0]);
        work.load_J += work_of(values[3], values[2]);
        const auto rms = [](const std::vector<double>& samples) {
            double sum = 0.0;
            for (const double sample : samples) sum += sample * sample;
            return std::sqrt(sum / static_cast<double>(samples.size()));
        };
        work.motor_path_Nm_rad += range_of(values[0]).span() * rms(values[1]);
        work.load_path_Nm_rad += range_of(values[2]).span() * rms(values[3]);
        angle_span = std::max({angle_span, range_of(values[0]).span(), range_of(values[2]).span()});
    }
    std::vector<Finding> found;
    // Whatever the signs of the load, it can have given no more work than this.
    if (work.motor_J < -1.05 * std::abs(work.load_J))
        found.push_back({.kind = FindingKind::wrong_sign,
                         .channel = channel::motor_torque,
                         .amount = -1.0,
                         .words = fmt::format(
                             "over closed loops the motor takes {:.3g} J from the transmission and the load "
                             "gives at most {:.3g} J, but friction creates no work: the sign of "
                             "motor_torque or of motor_angle looks wrong",
                             -work.motor_J, std::abs(work.load_J))});
    if (work.motor_path_Nm_rad <= 0.0 || work.load_path_Nm_rad <= 0.0) return found;
    const double passed_on = work.load_path_Nm_rad / work.motor_path_Nm_rad;
    constexpr double largest_angle_rad = 8.0 * std::numbers::pi;  // four turns; more is rather in degrees
    constexpr double min_passed_on = 0.02;  // friction of exp(-4), a wrap of three turns at 0.2
    constexpr double max_passed_on = 5.0;   // a load that drives the motor through the same friction
    constexpr double rather_torque =
        300.0;  // between the factors of a degree, 57, and of a millinewton metre, 1000
    const bool large_angle = angle_span > largest_angle_rad;
    if (passed_on > min_passed_on && passed_on < max_passed_on && !large_angle) return found;
    const double off = passed_on > 1.0 ? passed_on : 1.0 / passed_on;
    const char* unit = !large_angle && off > rather_torque ? "mN m" : "deg";
    std::string suspect = channel::motor_angle;
    const double motor_span = range_of(recording.runs[0].values[at[0]]).span();
    const double load_span = range_of(recording.runs[0].values[at[2]]).span();
    if (std::string(unit) == "deg") {
        suspect = motor_span > load_span ? channel::motor_angle : channel::load_angle;
    } else {
        suspect = passed_on > 1.0 ? channel::load_torque : channel::motor_torque;
    }
    found.push_back(
        {.kind = FindingKind::wrong_unit,
         .channel = suspect,
         .amount = find_unit(unit)->si,
         .words = fmt::format(
             "torque times angle at the load is {:.3g} times that at the motor, and the angles reach {:.3g} "
             "rad: the unit of {} looks wrong, perhaps {}, or that of another channel of the four",
             passed_on, angle_span, suspect, unit)});
    return found;
}

}  // namespace

std::vector<double> modelled_channel(const Recording& recording, std::size_t run, std::size_t channel) {
    try {
        const auto twin = gap::make_twin(recording, modelled_segments);
        return twin->run(run, gap::nominal_values(*twin)).values[channel];
    } catch (const InvalidInput&) {  // the driven channels determine no motion
        return {};
    }
}

std::vector<Finding> doubts_of(const Recording& recording) {
    if (recording.runs.empty()) return {};
    if (recording.nominal) return doubts_by_model(recording);
    if (recording.mode == BenchMode::lumped_drive) return doubts_by_work(recording);
    return {};
}

}  // namespace capstan::imports
