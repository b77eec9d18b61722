#include "capstan/calibration/twin_residuals.h"

#include <algorithm>
#include <cmath>

#include "capstan/platform/parallel_for.h"
#include "capstan/platform/work_meter.h"
#include "capstan/recording/driven_inputs.h"

namespace capstan::gap {

namespace {

constexpr double block_s = 1.0;

int first_scored(const RecordedRun& run, const Twin& twin) {
    const auto first =
        std::lower_bound(run.time_s.begin(), run.time_s.end(), run.time_s.front() + twin.unscored_s());
    return static_cast<int>(first - run.time_s.begin());
}

}  // namespace

TwinResiduals::TwinResiduals(const Recording& recording, const Twin& twin, int threads)
    : recording_(recording),
      twin_(twin),
      threads_(threads),
      scales_(recording.runs.size(), std::vector<double>(recording.channels.size(), 1.0)) {
    const std::vector<double> nominal = nominal_values(twin);
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        const TwinRun twin_run = twin.run(run, nominal);
        predicted_.emplace_back();
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
            if (!twin_run.values[channel].empty()) predicted_.back().push_back(static_cast<int>(channel));
        }
    }
}

std::vector<RunPart> TwinResiduals::complete_runs() const {
    std::vector<RunPart> parts;
    for (std::size_t run = 0; run < recording_.runs.size(); ++run)
        parts.push_back({run, first_scored(recording_.runs[run], twin_), recording_.runs[run].samples()});
    return parts;
}

std::vector<RunPart> TwinResiduals::blocks(const std::vector<RunPart>& parts) const {
    const int length = std::max(1, static_cast<int>(std::lround(block_s * recording_.sample_rate_Hz)));
    std::vector<RunPart> all;
    for (const RunPart& part : parts) {
        for (int first = part.first; first < part.end; first += length)
            all.push_back({part.run, first, std::min(first + length, part.end)});
    }
    return all;
}

int TwinResiduals::rows(const RunPart& block) const {
    return (block.end - block.first) * static_cast<int>(predicted_[block.run].size());
}

std::vector<Eigen::Index> TwinResiduals::block_ends(const std::vector<RunPart>& parts) const {
    std::vector<Eigen::Index> ends;
    Eigen::Index end = 0;
    for (const RunPart& block : blocks(parts)) ends.push_back(end += rows(block));
    return ends;
}

Eigen::MatrixXd TwinResiduals::of(const std::vector<RunPart>& parts,
                                  const std::vector<std::vector<double>>& values) const {
    std::vector<Eigen::Index> first_row(parts.size());
    Eigen::Index row_count = 0;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        first_row[part] = row_count;
        for (const RunPart& block : blocks({parts[part]})) row_count += rows(block);
    }
    Eigen::MatrixXd residuals(row_count, static_cast<Eigen::Index>(values.size()));
    const int tasks = static_cast<int>(parts.size() * values.size());
    parallel_for_each_index(tasks, threads_, [&](int task) {
        const std::size_t part = static_cast<std::size_t>(task) % parts.size();
        const std::size_t column = static_cast<std::size_t>(task) / parts.size();
        const std::size_t run = parts[part].run;
        const TwinRun twin_run = twin_.run(run, values[column]);
        note_work();
        Eigen::Index row = first_row[part];
        for (const RunPart& block : blocks({parts[part]})) {
            for (const int index : predicted_[run]) {
                const auto channel = static_cast<std::size_t>(index);
                for (int k = block.first; k < block.end; ++k) {
                    const auto sample = static_cast<std::size_t>(k);
                    residuals(row++, static_cast<Eigen::Index>(column)) =
                        (recording_.runs[run].values[channel][sample] - twin_run.values[channel][sample]) /
                        scales_[run][channel];
                }
            }
        }
    });
    return residuals;
}

void TwinResiduals::set_scales(const std::vector<double>& values) {
    for (std::size_t run = 0; run < recording_.runs.size(); ++run) {
        const ChannelErrors errors = rms(run, values);
        for (const int index : predicted_[run]) {
            const auto channel = static_cast<std::size_t>(index);
            const double noise = sample_noise(recording_.channels[channel]);
            const double scale = std::max(*errors.rms[channel], noise);
            scales_[run][channel] = scale > 0.0 ? scale : 1.0;
        }
    }
}

ChannelErrors TwinResiduals::rms(std::size_t run, const std::vector<double>& values) const {
    const TwinRun twin_run = twin_.run(run, values);
    const RecordedRun& recorded = recording_.runs[run];
    const int first = first_scored(recorded, twin_);
    ChannelErrors errors;
    errors.unsolved_steps = twin_run.unsolved_steps;
    errors.rms.resize(recording_.channels.size());
    for (const int index : predicted_[run]) {
        const auto channel = static_cast<std::size_t>(index);
        double squares = 0.0;
        for (int k = first; k < recorded.samples(); ++k) {
            const auto sample = static_cast<std::size_t>(k);
            squares += std::pow(recorded.values[channel][sample] - twin_run.values[channel][sample], 2);
        }
        errors.rms[channel] = std::sqrt(squares / (recorded.samples() - first));
    }
    return errors;
}

}  // namespace capstan::gap
