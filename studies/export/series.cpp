#include "capstan/export/series.h"

#include <fmt/format.h>

namespace capstan::exports {

std::vector<Series> series_of(const Recording& recording) {
    std::vector<Series> list;
    for (const RecordedRun& run : recording.runs) {
        Series& series = list.emplace_back();
        series.name = fmt::format("run_{}", run.number);
        series.time_s = run.time_s;
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel)
            series.channels.push_back(
                {recording.channels[channel].name, recording.channels[channel].unit, run.values[channel]});
    }
    return list;
}

bool is_series_file(const std::filesystem::path& path) {
    return path.extension() == ".mat" || path.extension() == ".mcap";
}

void write_series(const std::filesystem::path& path, const std::vector<Series>& series) {
    path.extension() == ".mat" ? write_mat_file(path, series) : write_mcap_file(path, series);
}

}  // namespace capstan::exports
