#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/answers/recording_answers.h"

namespace capstan::answers {

namespace {

using gap::TwinRun;
using reports::Data;
using reports::Table;

// Of all curves together: each takes about 60 bytes a sample, and the page stays below 3 MB.
constexpr std::size_t drawn_recording_samples = 15000;

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
        "channel_residual", "Measured minus modelled", {"run", "channel", "time_s", "residual"}, {}};
    Data rows = Data::list();
};

void add_channel(Overlay& overlay, const RecordedRun& run, const Channel& channel,
                 const std::vector<double>& measured, const std::vector<double>& model, std::size_t limit) {
    const auto number = std::int64_t{run.number};
    const std::string name = drawn_name(channel);
    const std::size_t every = reports::drawn_every(measured.size(), limit);
    for (const auto& [series, values] : {std::pair{"measured", &measured}, {"modelled", &model}}) {
        for (std::size_t k = 0; k < values->size(); k += every)
            overlay.channel.rows.push_back({number, name, run.time_s[k], series, (*values)[k]});
    }
    for (std::size_t k = 0; k < measured.size(); k += every)
        overlay.residual.rows.push_back({number, name, run.time_s[k], measured[k] - model[k]});
    const double left = rms(measured, model);
    const double signal = rms_about_mean(measured);
    overlay.rows.push_back({{"channel", channel.name},
                            {"run", run.number},
                            {"unit", channel.unit},
                            {"residual_rms", left},
                            {"signal_rms", signal},
                            {"fraction", signal > 0.0 ? Data(left / signal) : Data()}});
}

Overlay overlay_of(const Recording& recording, const std::vector<TwinRun>& modelled) {
    Overlay overlay;
    const std::size_t limit = drawn_recording_samples / std::max<std::size_t>(1, modelled_channels(modelled));
    for (std::size_t r = 0; r < recording.runs.size(); ++r) {
        const RecordedRun& run = recording.runs[r];
        overlay.run.rows.push_back({std::int64_t{run.number}, run.protocol, std::int64_t{run.samples()},
                                    std::int64_t{modelled[r].unsolved_steps}});
        for (std::size_t c = 0; c < recording.channels.size(); ++c) {
            const std::vector<double>& model = modelled[r].values[c];
            if (!model.empty()) add_channel(overlay, run, recording.channels[c], run.values[c], model, limit);
        }
    }
    return overlay;
}

}  // namespace

reports::Answer recording_answer(const Recording& recording, const std::vector<TwinRun>& modelled) {
    Overlay overlay = overlay_of(recording, modelled);
    reports::Answer answer{
        .id = "recording",
        .kind = "A recording and its model",
        .title = recording.name,
        .headline = fmt::format(
            "{} {}, {} samples at {:.4g} Hz: measured channels and the model driven by the same inputs.",
            recording.runs.size(), recording.runs.size() == 1 ? "run" : "runs", recording.samples(),
            recording.sample_rate_Hz)};
    answer.values = {{"case", recording.name}, {"channels", overlay.rows}};
    answer.sections = {
        {.id = "runs",
         .heading = "Measured and modelled",
         .prose = "Only channels that the model predicts are drawn; the others drive it, freed of "
                  "noise. Long runs are thinned evenly for drawing; the numbers are of every sample.",
         .tables = {{"channels",
                     "Residual of each channel, over all samples",
                     {worded_column("channel"),
                      {"run", "run"},
                      {"unit", "unit"},
                      {"residual_rms", "RMS of residual", "", ".3g"},
                      {"signal_rms", "RMS of signal", "", ".3g"},
                      {"fraction", "fraction", "", ".0%"}},
                     overlay.rows}}}};
    answer.drawn = {std::move(overlay.run), std::move(overlay.channel), std::move(overlay.residual)};
    return answer;
}

}  // namespace capstan::answers
