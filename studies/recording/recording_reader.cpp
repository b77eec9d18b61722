#include "capstan/recording/recording_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "capstan/platform/statistics.h"
#include "capstan/recording/csv_numbers.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/recording/json_object.h"

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

// The table's columns for `t` and each channel, in that order.
std::vector<std::size_t> columns_of(const CsvNumbers& table, const Recording& recording,
                                    const std::string& place, ProblemList& problems) {
    std::vector<std::string> wanted = {"t"};
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
        if (name != "run" && std::find(wanted.begin(), wanted.end(), name) == wanted.end())
            problems.add(place,
                         fmt::format("column '{}' is not in the sidecar's `units`; what is it?", name));
    }
    return columns;
}

// Deals the rows out to the runs, in the file's order.
void deal_out(const CsvNumbers& table, const std::vector<std::size_t>& columns, const std::string& path,
              Recording& recording, ProblemList& problems) {
    for (RecordedRun& run : recording.runs) run.values.assign(recording.channels.size(), {});
    const auto run_column = column_of(table, "run");
    for (std::size_t row = 0; row < table.rows(); ++row) {
        const double number = run_column ? table.values[*run_column][row] : 1.0;
        const auto run = std::find_if(recording.runs.begin(), recording.runs.end(),
                                      [&](const RecordedRun& r) { return r.number == number; });
        const std::string place = fmt::format("{}:{}", path, CsvNumbers::line_of(row));
        if (run == recording.runs.end()) {
            problems.add_line(fmt::format("run {}", number), place,
                              fmt::format("run {} is not in the sidecar's list of runs", number));
            continue;
        }
        check_next_time(*run, table.values[columns[0]][row], recording.sample_rate_Hz, place, problems);
        run->time_s.push_back(table.values[columns[0]][row]);
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel)
            run->values[channel].push_back(table.values[columns[1 + channel]][row]);
    }
}

// A stated duration is a note of the laboratory's. Where the samples contradict it, some are missing, or a
// time is in another unit.
void note_other_durations(const nlohmann::json& sidecar, const std::filesystem::path& path,
                          Recording& recording) {
    constexpr double tolerance = 0.1;
    if (!sidecar.contains("runs")) return;
    for (const nlohmann::json& stated : sidecar.at("runs")) {
        const auto duration = stated.find("duration");
        const auto run =
            std::find_if(recording.runs.begin(), recording.runs.end(),
                         [&](const RecordedRun& each) { return stated.value("run", 0) == each.number; });
        if (duration == stated.end() || !duration->is_number() || run == recording.runs.end()) continue;
        const double stated_s = *duration;
        const double recorded_s = run->time_s.back() - run->time_s.front();
        if (std::abs(recorded_s - stated_s) <= tolerance * stated_s + 1.0 / recording.sample_rate_Hz)
            continue;
        recording.assumptions.push_back(fmt::format(
            "{}: the duration of run {} is {:.4g} s, but its samples last {:.4g} s, which counts; are samples missing, or "
            "is a time in another unit?",
            path.filename().string(), run->number, stated_s, recorded_s));
    }
}

SampleTable sample_table(const CsvNumbers& table) {
    SampleTable samples{table.columns, {}, 0.0};
    const auto run_column = column_of(table, "run");
    if (!run_column) samples.run_numbers = {1};
    for (std::size_t row = 0; run_column && row < table.rows(); ++row) {
        const double number = table.values[*run_column][row];
        if (std::abs(number) < 1e9 && number == std::floor(number) &&
            std::find(samples.run_numbers.begin(), samples.run_numbers.end(), static_cast<int>(number)) ==
                samples.run_numbers.end())
            samples.run_numbers.push_back(static_cast<int>(number));
    }
    if (const auto time = column_of(table, "t")) {
        std::vector<double> periods_s;
        const std::vector<double>& times_s = table.values[*time];
        for (std::size_t row = 1; row < times_s.size(); ++row) {
            if (times_s[row] > times_s[row - 1]) periods_s.push_back(times_s[row] - times_s[row - 1]);
        }
        samples.period_s = median(std::move(periods_s));
    }
    return samples;
}

}  // namespace

RecordingPaths recording_paths(const std::filesystem::path& name) {
    const std::string ending = name.extension().string();
    const std::filesystem::path base =
        ending == ".csv" || ending == ".json" ? name.parent_path() / name.stem() : name;
    return {base.string() + ".csv", base.string() + ".json"};
}

Recording read_recording(const std::filesystem::path& path, ProblemList& problems) {
    const auto [samples_path, sidecar_path] = recording_paths(path);
    if (std::filesystem::is_regular_file(path) && path != samples_path && path != sidecar_path) {
        problems.add(
            path.string(),
            "is not a recording, which is NAME.csv with NAME.json; `capstan import` makes one of a laboratory's log");
        return {};
    }
    if (!std::filesystem::exists(samples_path) && !std::filesystem::exists(sidecar_path)) {
        problems.add(
            samples_path.string(),
            fmt::format("does not exist, nor does {}; a recording is NAME.csv with NAME.json beside it",
                        sidecar_path.filename().string()));
        return {};
    }
    if (std::filesystem::exists(samples_path) && !std::filesystem::exists(sidecar_path)) {
        problems.add(
            sidecar_path.string(),
            fmt::format("does not exist; it describes the recording {}. `capstan recording template` writes "
                        "one to fill in, and `capstan import` makes a recording from a laboratory's log",
                        samples_path.string()));
        return {};
    }
    const nlohmann::json json = read_json_file(sidecar_path);
    const CsvNumbers table = read_csv_numbers(samples_path, problems);
    Recording recording = read_sidecar(json, sidecar_path, sample_table(table), problems);
    order_as_in(table, recording);
    const std::vector<std::size_t> columns =
        columns_of(table, recording, samples_path.string() + ":1", problems);
    if (!problems.empty()) return recording;
    deal_out(table, columns, samples_path.string(), recording, problems);
    if (problems.empty()) check_recording(recording, samples_path.string(), problems);
    if (problems.empty()) note_other_durations(json, sidecar_path, recording);
    return problems.empty() ? with_estimated_noise(std::move(recording)) : recording;
}

Recording read_recording(const std::filesystem::path& path) {
    ProblemList problems;
    Recording recording = read_recording(path, problems);
    problems.throw_if_any();
    return recording;
}

}  // namespace capstan
