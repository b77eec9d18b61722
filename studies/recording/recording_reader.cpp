#include "capstan/recording/recording_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/recording/csv_numbers.h"

namespace capstan {

namespace {

std::optional<std::size_t> column_of(const CsvNumbers& table, const std::string& name) {
    const auto found = std::find(table.columns.begin(), table.columns.end(), name);
    if (found == table.columns.end()) return std::nullopt;
    return static_cast<std::size_t>(found - table.columns.begin());
}

// The channels in the order of the file's columns: the sidecar's keys have none.
void order_as_in(const CsvNumbers& table, Recording& recording) {
    const auto place = [&](const Channel& channel) {
        return column_of(table, channel.name).value_or(table.columns.size());
    };
    std::stable_sort(recording.channels.begin(), recording.channels.end(),
                     [&](const Channel& a, const Channel& b) { return place(a) < place(b); });
}

// The table's columns for `run`, `t` and each channel, in that order.
std::vector<std::size_t> columns_of(const CsvNumbers& table, const Recording& recording,
                                    const std::string& place, ProblemList& problems) {
    std::vector<std::string> wanted = {"run", "t"};
    for (const Channel& channel : recording.channels) wanted.push_back(channel.name);
    std::vector<std::size_t> columns;
    for (const std::string& name : wanted) {
        if (const auto column = column_of(table, name)) {
            columns.push_back(*column);
        } else {
            problems.add(place, fmt::format("no column '{}', which the sidecar lists", name));
        }
    }
    for (const std::string& name : table.columns) {
        if (std::find(wanted.begin(), wanted.end(), name) == wanted.end())
            problems.add(place,
                         fmt::format("column '{}' is not in the sidecar's `units`; what is it?", name));
    }
    return columns;
}

// Deals the rows out to the runs, in the file's order.
void deal_out(const CsvNumbers& table, const std::vector<std::size_t>& columns, const std::string& path,
              Recording& recording, ProblemList& problems) {
    for (RecordedRun& run : recording.runs) run.values.assign(recording.channels.size(), {});
    const std::vector<double>& numbers = table.values[columns[0]];
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const auto run = std::find_if(recording.runs.begin(), recording.runs.end(),
                                      [&](const RecordedRun& r) { return r.number == numbers[row]; });
        const std::string place = fmt::format("{}:{}", path, CsvNumbers::line_of(row));
        if (run == recording.runs.end()) {
            problems.add(place, fmt::format("run {} is not in the sidecar's list of runs", numbers[row]));
            continue;
        }
        check_next_time(*run, table.values[columns[1]][row], recording.sample_rate_Hz, place, problems);
        run->time_s.push_back(table.values[columns[1]][row]);
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel)
            run->values[channel].push_back(table.values[columns[2 + channel]][row]);
    }
}

}  // namespace

Recording read_recording(const std::filesystem::path& path) {
    std::filesystem::path samples_path = path;
    std::filesystem::path sidecar_path = path;
    samples_path.replace_extension(".csv");
    sidecar_path.replace_extension(".json");

    ProblemList problems;
    Recording recording = read_sidecar(sidecar_path, problems);
    const CsvNumbers table = read_csv_numbers(samples_path, problems);
    order_as_in(table, recording);
    const std::vector<std::size_t> columns =
        columns_of(table, recording, samples_path.string() + ":1", problems);
    problems.throw_if_any();
    deal_out(table, columns, samples_path.string(), recording, problems);
    problems.throw_if_any();
    check_recording(recording, samples_path.string(), problems);
    problems.throw_if_any();
    return recording;
}

}  // namespace capstan
