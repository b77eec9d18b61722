#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "capstan/import/clock_offset.h"
#include "capstan/import/import_state.h"
#include "capstan/import/plausibility.h"

namespace capstan::imports {

namespace {

// A channel that lags more than this is another experiment's.
constexpr double longest_offset_s = 1.0;
// Within one logger only a filter or a slow bus delays a channel.
constexpr double longest_delay_s = 0.1;
// An offset is named when it is more than this many samples and its own uncertainty.
constexpr double named_offset_periods = 0.75;
// Without it the others leave at least so many times more of the channel's variance; more within one logger,
// where an offset is not to be expected.
constexpr double named_offset_gain = 1.5;
constexpr double named_delay_gain = 2.5;
// It is larger than so many times its uncertainty, in which the error of the model is not.
constexpr double named_offset_uncertainties = 3.0;
// A channel that is not shifted is off by no more than its offset and so many times that uncertainty.
constexpr double stated_uncertainties = 2.0;
constexpr double aligned_periods = 2.0;  // within so many samples it needs no word
// How wrong the model of friction may be, as a part of a channel's variance. Angles follow one another
// exactly but for stretch.
constexpr double angle_model_error = 1e-6;
constexpr double torque_model_error = 2e-3;
constexpr double nominal_model_error = 2e-4;
constexpr std::size_t max_runs_looked_at = 6;

// Samples of a run at one rate, for looking at it: its longest piece.
std::vector<std::vector<double>> preview_of(const ImportState& state, std::size_t run, std::size_t limit,
                                            double& rate_Hz) {
    const auto& pieces = state.plans[run].pieces;
    const auto longest = std::max_element(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
        return a.to_s - a.from_s < b.to_s - b.from_s;
    });
    std::vector<std::vector<double>> values(state.kept.size());
    if (longest == pieces.end()) return values;
    Piece piece = *longest;
    rate_Hz = state.plans[run].surveys.front().period_s > 0.0
                  ? 1.0 / state.plans[run].surveys.front().period_s
                  : 1.0;
    piece.grid_Hz = rate_Hz;
    piece.thinned_by = 1;
    piece.to_s = std::min(piece.to_s, piece.from_s + static_cast<double>(limit) / rate_Hz);
    for_each_row(state.logs.runs[run], piece, state.kept, [&](double, std::span<const double> row) {
        for (std::size_t k = 0; k < row.size(); ++k) values[k].push_back(row[k]);
    });
    return values;
}

bool same_clock(const ImportState& state, const LogRun& run, std::size_t a, std::size_t b) {
    return run.sources[state.kept[a]].clock.is(run.sources[state.kept[b]].clock);
}

// What the runs say of a channel's offset together.
struct ChannelOffset {
    std::size_t channel = 0;  ///< kept
    ClockOffset offset;
    double period_s = 0.0;
    bool other_clock = false;
};

ChannelOffset together(std::size_t k, const std::vector<ClockOffset>& found, double period_s,
                       bool other_clock) {
    ChannelOffset all{k, found.front(), period_s, other_clock};
    double low = found.front().offset_s;
    double high = low;
    double sum = 0.0;
    for (const ClockOffset& offset : found) {
        sum += offset.offset_s;
        low = std::min(low, offset.offset_s);
        high = std::max(high, offset.offset_s);
        all.offset.uncertainty_s = std::max(all.offset.uncertainty_s, offset.uncertainty_s);
        all.offset.unexplained = std::max(all.offset.unexplained, offset.unexplained);
        all.offset.unexplained_at_zero = std::min(all.offset.unexplained_at_zero, offset.unexplained_at_zero);
    }
    all.offset.offset_s = sum / static_cast<double>(found.size());
    all.offset.uncertainty_s = std::max(all.offset.uncertainty_s, 0.5 * (high - low));
    return all;
}

std::optional<ChannelOffset> channel_offset(const ImportState& state, std::size_t k,
                                            const std::vector<std::size_t>& aligned, bool other_clock) {
    std::vector<ClockOffset> found;
    double rate_Hz = 1.0;
    for (std::size_t run = 0; run < state.logs.runs.size() && found.size() < max_runs_looked_at; ++run) {
        if (state.plans[run].pieces.empty()) continue;
        const auto values = preview_of(state, run, 3 * preview_samples, rate_Hz);
        std::vector<ClockReference> others;
        for (const std::size_t other : aligned) {
            // An angle follows an angle, without friction's lag.
            if (!state.is_angle(k) || state.is_angle(other))
                others.push_back({values[other], state.is_angle(other) && !state.is_angle(k)});
        }
        const auto offset =
            find_clock_offset(values[k], others, rate_Hz, other_clock ? longest_offset_s : longest_delay_s,
                              state.is_angle(k) ? angle_model_error : torque_model_error);
        if (offset) found.push_back(*offset);
    }
    if (found.empty()) return std::nullopt;
    return together(k, found, 1.0 / rate_Hz, other_clock);
}

bool is_constant(const ImportState& state, std::size_t k) {
    return std::all_of(state.plans.begin(), state.plans.end(), [&](const StretchPlan& plan) {
        return plan.surveys.empty() || plan.surveys[state.kept[k]].constant();
    });
}

// A channel of a clock of its own beside what the nominal model says of it from the aligned inputs.
std::optional<ChannelOffset> offset_by_model(ImportState& state, std::size_t k,
                                             const std::vector<std::size_t>& aligned) {
    const Recording recording = preview_recording(state);
    if (!recording.nominal) return std::nullopt;
    std::vector<ClockOffset> found;
    double period_s = 1.0;
    for (std::size_t run = 0; run < recording.runs.size() && found.size() < max_runs_looked_at; ++run) {
        const RecordedRun& recorded = recording.runs[run];
        const bool inputs_aligned =
            std::all_of(recorded.driven.begin(), recorded.driven.end(), [&](const auto& name) {
                const auto channel = recording.channel(name);
                return channel && (is_constant(state, static_cast<std::size_t>(*channel)) ||
                                   std::find(aligned.begin(), aligned.end(),
                                             static_cast<std::size_t>(*channel)) != aligned.end());
            });
        if (!inputs_aligned || recorded.samples() < 2) continue;
        const std::vector<double> modelled = modelled_channel(recording, run, k);
        if (modelled.empty()) continue;
        period_s = (recorded.time_s.back() - recorded.time_s.front()) / (recorded.samples() - 1);
        if (const auto offset = find_clock_offset(recorded.values[k], {{modelled, false, false}},
                                                  1.0 / period_s, longest_offset_s, nominal_model_error))
            found.push_back(*offset);
    }
    if (found.empty()) return std::nullopt;
    return together(k, found, period_s, true);
}

void note_shift(ImportState& state, const ChannelOffset& by, std::size_t k) {
    const std::string& name = state.report.channels[k];
    const double rounded_s = std::round(by.offset.offset_s * 1e5) / 1e5;
    const std::string from =
        k == by.channel
            ? fmt::format("+-{:.2g} ms; without it {:.1f}% of its variance is unexplained, with it {:.1f}%",
                          1e3 * by.offset.uncertainty_s, 100.0 * by.offset.unexplained_at_zero,
                          100.0 * by.offset.unexplained)
            : fmt::format("as that of {}, which shares it", state.report.channels[by.channel]);
    state.report.findings.push_back(
        {.kind = FindingKind::clock_offset,
         .repaired = by.other_clock,
         .channel = name,
         .amount = rounded_s,
         .uncertainty = by.offset.uncertainty_s,
         .words = fmt::format("the clock of {} is {:.4g} ms {} that of the other channels ({}); {}", name,
                              std::abs(1e3 * rounded_s), rounded_s > 0 ? "behind" : "ahead of", from,
                              by.other_clock
                                  ? "it is shifted"
                                  : fmt::format("state clock_offset_s = {:.5f} to shift it", rounded_s))});
    if (!by.other_clock) return;
    for (LogRun& run : state.logs.runs) run.sources[state.kept[k]].clock_offset_s = rounded_s;
}

// All channels of the clock are shifted, or it is said that they are late. True if one was shifted.
bool settle_offset(ImportState& state, const ChannelOffset& found, const LogRun& run) {
    const ClockOffset& offset = found.offset;
    const double gain = found.other_clock ? named_offset_gain : named_delay_gain;
    if (offset.unexplained_at_zero <= gain * offset.unexplained) return false;
    if (std::abs(offset.offset_s) <
        std::max(named_offset_periods * found.period_s, named_offset_uncertainties * offset.uncertainty_s))
        return false;
    for (std::size_t k = 0; k < state.kept.size(); ++k) {
        if (k == found.channel || (found.other_clock && same_clock(state, run, k, found.channel) &&
                                   !state.mapping.channels[state.kept[k]].clock_offset_s))
            note_shift(state, found, k);
    }
    return found.other_clock;
}

// How far a channel that is not shifted is off at most. `offset`: nothing where no shift explains the
// channel.
double known_to_s(const std::optional<ChannelOffset>& offset) {
    return offset ? std::abs(offset->offset.offset_s) + stated_uncertainties * offset->offset.uncertainty_s
                  : longest_offset_s;
}

bool is_aligned(const std::optional<ChannelOffset>& offset) {
    return offset && known_to_s(offset) <= aligned_periods * offset->period_s;
}

// Said of all channels of the clock.
void note_doubt(ImportState& state, std::size_t doubted, const std::optional<ChannelOffset>& offset,
                const LogRun& run) {
    const std::string how =
        offset
            ? fmt::format("this log tells how far they are off only to {:.0f} ms", 1e3 * known_to_s(offset))
            : "this log does not tell how far they are off, as the other channels explain too little of it";
    for (std::size_t k = 0; k < state.kept.size(); ++k) {
        if (!same_clock(state, run, k, doubted) || is_constant(state, k)) continue;
        const std::string& name = state.report.channels[k];
        state.report.findings.push_back(
            {.kind = FindingKind::clock_offset,
             .channel = name,
             .uncertainty = known_to_s(offset),
             .words =
                 k == doubted
                     ? fmt::format(
                           "{} has times of its own (another file, table or topic), and {}; it is not "
                           "shifted. State clock_offset_s if it is known, or log a motion with several speeds",
                           name, how)
                     : fmt::format("{} has the times of {}, and is not shifted either", name,
                                   state.report.channels[doubted])});
    }
}

}  // namespace

void align_clocks(ImportState& state) {
    std::vector<std::size_t> order(state.kept.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return state.is_angle(a) > state.is_angle(b); });
    const LogRun& run = state.logs.runs[state.pieces.front().log_run];
    std::vector<std::size_t> aligned;
    bool shifted = false;
    for (std::size_t at = 0; at < order.size(); ++at) {
        const std::size_t k = order[at];
        const bool known = aligned.empty() ||
                           state.mapping.channels[state.kept[k]].clock_offset_s.has_value() ||
                           std::any_of(aligned.begin(), aligned.end(),
                                       [&](std::size_t other) { return same_clock(state, run, k, other); });
        const bool late_angle =
            known && !aligned.empty() && state.is_angle(k) && same_clock(state, run, k, aligned.front());
        if (!known || late_angle) {
            auto offset = channel_offset(state, k, aligned, !known);
            if (!known && !state.is_angle(k)) {
                const auto modelled = offset_by_model(state, k, aligned);
                if (modelled && (!offset || modelled->offset.uncertainty_s < offset->offset.uncertainty_s))
                    offset = modelled;
            }
            const bool settled = offset && settle_offset(state, *offset, run);
            shifted |= settled;
            const bool another_may_tell =
                std::any_of(order.begin() + static_cast<std::ptrdiff_t>(at) + 1, order.end(),
                            [&](std::size_t later) { return same_clock(state, run, k, later); });
            if (!known && !offset && another_may_tell) continue;
            if (!known && !settled && !is_aligned(offset) && !is_constant(state, k))
                note_doubt(state, k, offset, run);
        }
        aligned.push_back(k);
    }
    if (!shifted) return;
    std::vector<Finding> again;  // with shifted clocks the common stretch is another one
    plan_runs(state, again);
    number_runs(state);
    for (Finding& finding : again) {
        const bool known = std::any_of(
            state.report.findings.begin(), state.report.findings.end(), [&](const Finding& other) {
                return other.kind == finding.kind && other.log_run == finding.log_run &&
                       other.channel == finding.channel;
            });
        if (!known) state.report.findings.push_back(std::move(finding));
    }
}

}  // namespace capstan::imports
