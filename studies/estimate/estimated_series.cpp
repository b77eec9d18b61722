#include "capstan/estimate/estimated_series.h"

#include <fmt/format.h>

#include <iterator>

#include "capstan/estimate/tracking.h"

namespace capstan::estimate {

std::vector<exports::Series> estimated_series(const std::vector<SensedCable>& cables,
                                              const std::vector<EstimatorTuning>& tuned,
                                              const TrackingOptions& options) {
    std::vector<exports::Series> all;
    for (std::size_t c = 0; c < cables.size(); ++c) {
        const Cable cut(cables[c].specification);
        const std::size_t first = all.size();
        for (const SensedRun& run : cables[c].runs) {
            exports::Series& series = all.emplace_back();
            series.name = fmt::format("run_{}/cable_{}", run.number, cables[c].name);
            for (int node = 0; node < cut.nodes(); ++node) {
                for (const char* what : {"tension", "band"})
                    series.channels.push_back(
                        {fmt::format("{}_at_{:.4g}m", what, cut.node_position_m(node)), "N", {}});
            }
        }
        track(cables[c], all_but(cables[c], {}), tuned[c].trust, options, [&](const TrackedSample& at) {
            exports::Series& series = all[first + at.run];
            series.time_s.push_back(cables[c].runs[at.run].time_s[at.sample]);
            for (std::size_t node = 0; node < at.nodes(); ++node) {
                const RecursiveEstimator::Moments moments = at.at_node(node);
                series.channels[2 * node].values.push_back(moments.mean_N);
                series.channels[2 * node + 1].values.push_back(band_N(moments, tuned[c].widening));
            }
        });
    }
    return all;
}

std::string estimated_csv(const std::vector<SensedCable>& cables,
                          const std::vector<exports::Series>& series) {
    std::string text = "run,t,cable";
    for (const exports::SeriesChannel& channel : series.front().channels)
        text += fmt::format(",{}_N", channel.name);
    text += "\n";
    auto out = std::back_inserter(text);
    auto next = series.begin();
    for (const SensedCable& cable : cables) {
        for (const SensedRun& run : cable.runs) {
            const exports::Series& lines = *next++;
            for (std::size_t sample = 0; sample < lines.time_s.size(); ++sample) {
                fmt::format_to(out, "{},{},{}", run.number, lines.time_s[sample], cable.name);
                for (std::size_t k = 0; k < lines.channels.size(); k += 2)
                    fmt::format_to(out, ",{:.6g},{:.4g}", lines.channels[k].values[sample],
                                   lines.channels[k + 1].values[sample]);
                text += "\n";
            }
        }
    }
    return text;
}

}  // namespace capstan::estimate
