#include "capstan/gap/gap_measure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "capstan/recording/block_bootstrap.h"

namespace capstan::gap {

namespace {

// Sums of squares over a block of time, or over all of a channel.
struct Squares {
    double before = 0.0;
    double after = 0.0;
    double held_out = 0.0;
    double runner_up = 0.0;
    double samples = 0.0;

    Squares& operator+=(const Squares& other) {
        before += other.before;
        after += other.after;
        held_out += other.held_out;
        runner_up += other.runner_up;
        samples += other.samples;
        return *this;
    }
};

double rms(double squares, double samples) {
    return std::sqrt(squares / samples);
}

double closed_fraction(const Squares& squares, double noise) {
    const double closable = squares.before - squares.samples * noise * noise;
    if (!(closable > 0.0)) return std::numeric_limits<double>::quiet_NaN();
    return std::min(1.0, (squares.before - squares.held_out) / closable);
}

ChannelGap summarised(const Channel& channel, const std::vector<Squares>& blocks) {
    Squares all;
    for (const Squares& block : blocks) all += block;
    ChannelGap gap;
    gap.channel = channel.name;
    gap.unit = channel.unit;
    gap.noise = sample_noise(channel);
    gap.before_rms = rms(all.before, all.samples);
    gap.after_rms = rms(all.after, all.samples);
    gap.held_out_rms = rms(all.held_out, all.samples);
    gap.runner_up_rms = rms(all.runner_up, all.samples);
    gap.closed = closed_fraction(all, gap.noise);
    std::vector<double> closed;
    for_each_bootstrap_draw(blocks.size(), 20222, [&](std::span<const std::size_t> drawn) {
        Squares sum;
        for (const std::size_t block : drawn) sum += blocks[block];
        const double fraction = closed_fraction(sum, gap.noise);
        if (!std::isnan(fraction)) closed.push_back(fraction);
    });
    const BootstrapInterval interval =
        closed.empty() ? BootstrapInterval{gap.closed, gap.closed} : middle_95(std::move(closed));
    gap.closed_low = interval.low;
    gap.closed_high = interval.high;
    return gap;
}

// One run in which each sample is predicted with the numbers that were fitted without it.
TwinRun held_out_run(const EffectsTwin& twin, std::size_t run, const std::vector<HeldOut>& parts) {
    TwinRun held_out;
    for (const HeldOut& part : parts) {
        if (part.left_out.run != run) continue;
        const TwinRun predicted = twin.run(run, part.numbers);
        if (held_out.values.empty()) held_out.values.resize(predicted.values.size());
        for (std::size_t channel = 0; channel < predicted.values.size(); ++channel) {
            const std::vector<double>& values = predicted.values[channel];
            held_out.values[channel].resize(values.size());
            const auto [first, last] = part.left_out.rows(values.size());
            std::copy(values.begin() + static_cast<std::ptrdiff_t>(first),
                      values.begin() + static_cast<std::ptrdiff_t>(last),
                      held_out.values[channel].begin() + static_cast<std::ptrdiff_t>(first));
        }
    }
    return held_out;
}

}  // namespace

GapMeasure measure_gap(const Recording& recording, const CauseFitter& fitter, const GapModels& models) {
    EffectsTwinOptions every_sample = fitter.twin().options();
    every_sample.stride = 1;
    every_sample.reports_sliding_fraction = true;
    const EffectsTwin twin(recording, every_sample);
    GapMeasure measure;
    std::vector<RunResiduals> nominal_residuals;
    std::vector<std::vector<Squares>> blocks(recording.channels.size());
    const int block = bootstrap_block_samples(recording);
    double worst = -1.0;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const BenchNumbers leading = models.leading.in_run(recording.runs[run]);
        const BenchNumbers runner_up = models.runner_up.in_run(recording.runs[run]);
        std::vector<TwinRun> twins =
            twin.run_each(std::vector<MovedBench>{{run, {}}, {run, leading}, {run, runner_up}});
        twins[1] = twin.with_faults(run, twins[1], leading.sensor_faults);
        twins[2] = twin.with_faults(run, twins[2], runner_up.sensor_faults);
        const TwinRun held_out = held_out_run(twin, run, models.held_out);
        RunResiduals residuals{run, {}, twins[0].sliding_fraction, 0};
        residuals.residual.resize(recording.channels.size());
        for (const ResidualSeries& series : fitter.series()) {
            if (series.run != run) continue;
            const std::size_t channel = series.channel;
            const std::vector<double>& measured = recording.runs[run].values[channel];
            residuals.first_sample = series.first_sample * fitter.twin().stride();
            const auto square = [&](const TwinRun& of, std::size_t sample) {
                return std::pow(measured[sample] - of.values[channel][sample], 2);
            };
            Squares sum;
            for (std::size_t sample = 0; sample < measured.size(); ++sample) {
                if (sample % static_cast<std::size_t>(block) == 0) {
                    if (sample > 0) sum += blocks[channel].back();
                    blocks[channel].emplace_back();
                }
                blocks[channel].back() += {square(twins[0], sample), square(twins[1], sample),
                                           square(held_out, sample), square(twins[2], sample), 1.0};
                residuals.residual[channel].push_back((measured[sample] - twins[0].values[channel][sample]) /
                                                      series.scale);
            }
            sum += blocks[channel].back();
            const double noise = sample_noise(recording.channels[channel]);
            const double ratio = rms(sum.before, sum.samples) / (noise > 0.0 ? noise : 1.0);
            if (ratio > worst) {
                worst = ratio;
                measure.worst_run = recording.runs[run].number;
                measure.worst_channel = recording.channels[channel].name;
            }
        }
        nominal_residuals.push_back(std::move(residuals));
        measure.nominal.push_back(std::move(twins[0]));
        measure.leading.push_back(std::move(twins[1]));
    }
    for (std::size_t channel = 0; channel < blocks.size(); ++channel) {
        if (!blocks[channel].empty())
            measure.channels.push_back(summarised(recording.channels[channel], blocks[channel]));
    }
    measure.map = gap_map(recording, nominal_residuals);
    measure.sortings = sample_sortings(recording, nominal_residuals);
    return measure;
}

}  // namespace capstan::gap
