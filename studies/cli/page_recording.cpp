#include "capstan/cli/page_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/cli/program.h"

namespace capstan::cli {

namespace {

using gap::TwinRun;
using reports::NumberTable;
using reports::Table;

// Of all curves together: each takes about 60 bytes a sample, and the page stays below 3 MB.
constexpr std::size_t drawn_samples = 15000;

std::size_t modelled_channels(const std::vector<TwinRun>& modelled) {
    std::size_t count = 0;
    for (const TwinRun& run : modelled)
        count += static_cast<std::size_t>(std::count_if(run.values.begin(), run.values.end(),
                                                        [](const auto& values) { return !values.empty(); }));
    return count;
}

double rms(const std::vector<double>& measured, const std::vector<double>& model) {
    double squares = 0.0;
    for (std::size_t k = 0; k < measured.size(); ++k) squares += std::pow(measured[k] - model[k], 2);
    return std::sqrt(squares / static_cast<double>(measured.size()));
}

double rms_about_mean(const std::vector<double>& measured) {
    double mean = 0.0;
    for (const double value : measured) mean += value / static_cast<double>(measured.size());
    return rms(measured, std::vector<double>(measured.size(), mean));
}

struct Overlay {
    Table run{"run", "Runs of the recording", {"run", "protocol", "samples", "unsolved_steps"}, {}};
    Table channel{
        "channel", "Measured and modelled channels", {"run", "channel", "time_s", "series", "value"}, {}};
    Table residual{
        "channel_residual", "Measured less modelled", {"run", "channel", "time_s", "residual"}, {}};
    NumberTable numbers{"Residual of each channel, over whole runs",
                        {"Channel", "Run", "Unit", "RMS of residual", "RMS of signal", "Fraction [%]"},
                        {}};
};

void add_channel(Overlay& overlay, const RecordedRun& run, const Channel& channel,
                 const std::vector<double>& measured, const std::vector<double>& model, std::size_t limit) {
    const auto number = std::int64_t{run.number};
    const std::string name = fmt::format("{} [{}]", channel.name, channel.unit);
    const std::size_t every = reports::drawn_every(measured.size(), limit);
    for (const auto& [series, values] : {std::pair{"measured", &measured}, {"modelled", &model}}) {
        for (std::size_t k = 0; k < values->size(); k += every)
            overlay.channel.rows.push_back({number, name, run.time_s[k], series, (*values)[k]});
    }
    for (std::size_t k = 0; k < measured.size(); k += every)
        overlay.residual.rows.push_back({number, name, run.time_s[k], measured[k] - model[k]});
    const double left = rms(measured, model);
    const double signal = rms_about_mean(measured);
    overlay.numbers.rows.push_back({channel.name, std::to_string(run.number), channel.unit,
                                    fmt::format("{:.3g}", left), fmt::format("{:.3g}", signal),
                                    signal > 0.0 ? fmt::format("{:.0f}", 1e2 * left / signal) : "-"});
}

Overlay overlay_of(const Recording& recording, const std::vector<TwinRun>& modelled) {
    Overlay overlay;
    const std::size_t limit = drawn_samples / std::max<std::size_t>(1, modelled_channels(modelled));
    for (std::size_t r = 0; r < recording.runs.size(); ++r) {
        const RecordedRun& run = recording.runs[r];
        overlay.run.rows.push_back({std::int64_t{run.number}, run.protocol, std::int64_t{run.samples()},
                                    std::int64_t{modelled[r].unsolved_steps}});
        for (std::size_t c = 0; c < recording.channels.size(); ++c) {
            const std::vector<double>& model = modelled[r].values[c];
            if (model.empty()) continue;
            add_channel(overlay, run, recording.channels[c], run.values[c], model, limit);
        }
    }
    return overlay;
}

}  // namespace

reports::ExperimentPage recording_page(const Recording& recording, const std::vector<TwinRun>& modelled) {
    Overlay overlay = overlay_of(recording, modelled);
    reports::ExperimentPage page;
    page.id = "recording";
    page.kind = "A recording and its model";
    page.title = recording.name;
    page.verdict = fmt::format(
        "{} {}, {} samples at {:.4g} Hz: what the bench measured, and what the model says to the same driven "
        "channels.",
        recording.runs.size(), recording.runs.size() == 1 ? "run" : "runs", recording.samples(),
        recording.sample_rate_Hz);
    page.sections = {
        {"runs",
         "Measured and modelled",
         "Only channels that the model predicts; those that drive it are fed to it, freed of noise. Long "
         "runs are thinned evenly for drawing; the numbers below are of every sample.",
         {std::move(overlay.numbers)},
         ""}};
    page.tables = {std::move(overlay.run), std::move(overlay.channel), std::move(overlay.residual)};
    page.program_version = program_version();
    return page;
}

}  // namespace capstan::cli
