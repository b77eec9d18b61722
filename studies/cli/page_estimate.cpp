#include "capstan/cli/page_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/cli/program.h"

namespace capstan::cli {

namespace {

using estimate::ChannelSet;
using estimate::LeftOutChannel;
using estimate::ModelTrust;
using estimate::SensedCable;
using estimate::SensedRun;
using estimate::TrackedSample;
using reports::NumberTable;
using reports::Table;

// Of all curves together, so that the page stays below 3 MB.
constexpr std::size_t drawn_samples = 15000;
constexpr double two_sided_95 = 1.959964;

struct Drawing {
    Table run{"run", "Runs of the recording", {"run", "protocol", "samples"}, {}};
    Table estimate{"estimate",
                   "Readings, estimates and bands",
                   {"run", "channel", "time_s", "read_N", "estimate_N", "low_N", "high_N"},
                   {}};
};

Drawing drawing_of(const Recording& recording) {
    Drawing drawing;
    for (const RecordedRun& run : recording.runs)
        drawing.run.rows.push_back({std::int64_t{run.number}, run.protocol, std::int64_t{run.samples()}});
    return drawing;
}

// What the estimator reading `used` says at the places of `drawn`.
void draw(Drawing& drawing, const SensedCable& cable, const ChannelSet& used, const ChannelSet& drawn,
          const ModelTrust& trust, double widening, const estimate::TrackingOptions& options,
          std::size_t limit) {
    CableSpecification specification = cable.specification;
    specification.pretension_N = cable.runs.front().pretension_N;
    const Cable cut(specification);
    track(cable, used, trust, options, [&](const TrackedSample& at) {
        const SensedRun& run = cable.runs[at.run];
        if (at.sample % reports::drawn_every(run.time_s.size(), limit) != 0) return;
        for (const std::size_t channel : drawn) {
            const estimate::SensedChannel& sensed = cable.channels[channel];
            const auto moments = at.estimator.at(spot_at(cut, sensed.position_m));
            const double half_N =
                std::hypot(estimate::band_N(moments, widening), two_sided_95 * sensed.noise_N);
            drawing.estimate.rows.push_back(
                {std::int64_t{run.number}, fmt::format("{} at {:.3f} m [N]", sensed.name, sensed.position_m),
                 run.time_s[at.sample], run.reading_N[channel][at.sample], moments.mean_N,
                 moments.mean_N - half_N, moments.mean_N + half_N});
        }
    });
}

reports::ExperimentPage page_of(const Recording& recording, Drawing drawing) {
    reports::ExperimentPage page;
    page.id = "estimate";
    page.kind = "The tension estimated from a recording";
    page.title = recording.name;
    page.tables = {std::move(drawing.run), std::move(drawing.estimate)};
    page.program_version = program_version();
    return page;
}

}  // namespace

reports::ExperimentPage left_out_page(const Recording& recording, const std::vector<LeftOutCable>& results,
                                      const estimate::TrackingOptions& options) {
    Drawing drawing = drawing_of(recording);
    NumberTable numbers{"Each channel predicted without itself, in newtons",
                        {"Channel", "Noise", "Error (RMS)", "In 95% band [%]", "Mean half width",
                         "Model alone", "Paper's Mean", "Paper's Mean-R"},
                        {}};
    std::size_t curves = 0;
    for (const LeftOutCable& cable : results) curves += cable.channels.size() * cable.cable->runs.size();
    double least = 1.0;
    for (const LeftOutCable& cable : results) {
        for (const LeftOutChannel& result : cable.channels) {
            const std::size_t one[] = {result.channel};
            draw(drawing, *cable.cable, all_but(*cable.cable, one), {result.channel}, result.trust,
                 result.widening, options, drawn_samples / std::max<std::size_t>(1, curves));
            const auto& channel = cable.cable->channels[result.channel];
            least = std::min(least, result.coverage);
            numbers.rows.push_back(
                {channel.name, fmt::format("{:.3f}", channel.noise_N), fmt::format("{:.3f}", result.rms_N),
                 fmt::format("{:.1f}", 1e2 * result.coverage), fmt::format("{:.3f}", result.mean_band_N),
                 fmt::format("{:.3f}", result.model_alone_rms_N),
                 fmt::format("{:.3f}", result.paper_mean_rms_N),
                 fmt::format("{:.3f}", result.paper_mean_r_rms_N)});
        }
    }
    reports::ExperimentPage page = page_of(recording, std::move(drawing));
    page.verdict = fmt::format(
        "Each channel as the others predict it; of the channel that the 95% band holds least often it holds {:.1f}% of "
        "the readings.",
        1e2 * least);
    page.sections = {
        {"runs",
         "Left out in turn",
         "The recursive estimator never saw the channel that is drawn. Error and band include the "
         "channel's own noise.",
         {std::move(numbers)},
         ""}};
    return page;
}

reports::ExperimentPage whole_page(const Recording& recording, const std::vector<SensedCable>& cables,
                                   const std::vector<estimate::WholeEstimate>& wholes,
                                   const estimate::TrackingOptions& options) {
    Drawing drawing = drawing_of(recording);
    NumberTable numbers{"How far the model is trusted",
                        {"Cable", "Channels", "Wander of an end a sample [um]", "Model error in fusing [%]",
                         "Widening of the band [%]"},
                        {}};
    std::size_t curves = 0;
    for (const SensedCable& cable : cables) curves += cable.channels.size() * cable.runs.size();
    for (std::size_t c = 0; c < cables.size(); ++c) {
        const ChannelSet all = all_but(cables[c], {});
        draw(drawing, cables[c], all, all, wholes[c].trust, wholes[c].widening, options,
             drawn_samples / std::max<std::size_t>(1, curves));
        numbers.rows.push_back({cables[c].name, std::to_string(cables[c].channels.size()),
                                fmt::format("{:.3g}", 1e6 * wholes[c].trust.wander_m),
                                fmt::format("{:.3g}", 1e2 * wholes[c].trust.error_ratio),
                                fmt::format("{:.3g}", 1e2 * wholes[c].widening)});
    }
    reports::ExperimentPage page = page_of(recording, std::move(drawing));
    page.verdict = "The tension from all channels together, drawn where there is one to compare with.";
    page.sections = {
        {"runs",
         "All channels used",
         "Each channel went into the estimate that is drawn over it; leaving channels out is the "
         "harder test.",
         {std::move(numbers)},
         ""}};
    return page;
}

}  // namespace capstan::cli
