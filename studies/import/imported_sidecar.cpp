#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "capstan/import/import_state.h"
#include "capstan/import/log_files.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::imports {

namespace {

using nlohmann::ordered_json;

const RunMapping* conditions_of(const ImportState& state, const LogRun& run) {
    if (run.mapping != nullptr || run.run_column == nullptr) return run.mapping;
    for (const RunMapping& mapped : state.mapping.runs) {
        const auto number = mapped.conditions.find("run");
        if (number != mapped.conditions.end() && number->is_number() &&
            number->get<double>() == run.run_value)
            return &mapped;
    }
    return nullptr;
}

// Of the converter: stated, or one count.
double step_of(const ImportState& state, std::size_t k) {
    const ChannelMapping& channel = state.mapping.channels[state.kept[k]];
    if (channel.step) return *channel.step;
    const auto unit = find_unit(channel.unit);
    const bool counts = unit ? unit->quantity == Quantity::counts : channel.scale.has_value();
    if (counts && (channel.scale || channel.counts_per_turn)) return std::abs(channel.factor());
    double step = 0.0;  // a lattice that all runs share
    if (!channel.name.ends_with("_angle")) return 0.0;
    for (const StretchPlan& plan : state.plans) {
        if (plan.surveys.empty()) continue;
        const double own = plan.surveys[state.kept[k]].step;
        if (own == 0.0 || (step != 0.0 && std::abs(own - step) > 0.02 * step)) return 0.0;
        step = own;
    }
    return std::round(step * 1e9) / 1e9;
}

// Without those of channels that are left out.
ordered_json kept_sensors(const ImportState& state, const ordered_json& sensors) {
    ordered_json kept = ordered_json::array();
    for (const auto& sensor : sensors) {
        const std::string channel = sensor.is_object() ? sensor.value("channel", "") : "";
        const bool mapped = std::any_of(state.mapping.channels.begin(), state.mapping.channels.end(),
                                        [&](const auto& each) { return each.name == channel; });
        const auto& channels = state.report.channels;
        if (!mapped || std::find(channels.begin(), channels.end(), channel) != channels.end())
            kept.push_back(sensor);
    }
    return kept;
}

ordered_json runs_json(const ImportState& state) {
    ordered_json runs = ordered_json::array();
    for (std::size_t index = 0; index < state.pieces.size(); ++index) {
        const LogRun& run = state.logs.runs[state.pieces[index].log_run];
        ordered_json entry = {{"run", state.report.runs[index].number},
                              {"source", state.report.runs[index].source}};
        if (const RunMapping* mapped = conditions_of(state, run)) {
            for (const auto& [key, value] : mapped->conditions.items()) entry[key] = value;
            entry["run"] = state.report.runs[index].number;
        }
        if (!entry.contains("t_session_start") && state.starts_s[index] > 0.0)
            entry["t_session_start"] = std::round(state.starts_s[index] * 1e6) / 1e6;
        runs.push_back(entry);
    }
    return runs;
}

std::string source_words(const ImportState& state, const LogRun& run, const Piece& piece) {
    std::string words = file_names(run.files);
    const StretchPlan& plan = state.plans[piece.log_run];
    if (plan.pieces.size() > 1)
        words += fmt::format(", {:.4g} s to {:.4g} s", piece.from_s - plan.pieces.front().from_s,
                             piece.to_s - plan.pieces.front().from_s);
    return words;
}

}  // namespace

void number_runs(ImportState& state) {
    state.report.runs.clear();
    state.starts_s.clear();
    std::set<int> used;
    double session_start_s = 0.0;
    bool first = true;
    for (const Piece& piece : state.pieces) {
        const LogRun& run = state.logs.runs[piece.log_run];
        int number = run.run_column != nullptr ? static_cast<int>(run.run_value) : 0;
        if (number <= 0 || used.count(number) > 0) number = used.empty() ? 1 : *used.rbegin() + 1;
        used.insert(number);
        if (first) session_start_s = piece.from_s;
        first = false;
        ImportedRun imported{number, source_words(state, run, piece), 0, piece.to_s - piece.from_s};
        state.report.runs.push_back(imported);
        state.starts_s.push_back(piece.from_s - session_start_s);
    }
}

ordered_json imported_sidecar(const ImportState& state) {
    ordered_json sidecar = {{"case", state.report.recording.name}, {"schema", 1}};
    if (state.mapping.recording.is_object()) {
        for (const auto& [key, value] : state.mapping.recording.items()) sidecar[key] = value;
    }
    sidecar["sample_rate_hz"] = state.report.sample_rate_Hz;
    if (sidecar.contains("tension_sensors") && sidecar["tension_sensors"].is_array())
        sidecar["tension_sensors"] = kept_sensors(state, sidecar["tension_sensors"]);
    ordered_json units = {{"t", "s"}};
    for (std::size_t k = 0; k < state.kept.size(); ++k) {
        const ChannelMapping& channel = state.mapping.channels[state.kept[k]];
        std::string unit(channel_unit(channel.name));
        if (unit.empty()) {
            const auto known = find_unit(channel.unit);
            unit = known ? std::string(si_unit(known->quantity)) : channel.unit;
        }
        units[channel.name] = unit;
        if (channel.noise_std) sidecar["noise_std"][channel.name] = *channel.noise_std;
        if (const double step = step_of(state, k); step > 0.0) sidecar["encoder_step"][channel.name] = step;
    }
    sidecar["units"] = units;
    sidecar["runs"] = runs_json(state);
    ordered_json repairs = ordered_json::array();
    for (const Finding& finding : state.report.findings) {
        if (finding.kind != FindingKind::assumed)
            repairs.push_back({{"what", finding_name(finding.kind)},
                               {"repaired", finding.repaired},
                               {"words", finding.words}});
    }
    sidecar["import"] = {{"files", state.report.files},
                         {"mapping", std::filesystem::path(state.mapping.file).filename().string()},
                         {"findings", repairs}};
    return sidecar;
}

Recording preview_recording(ImportState& state) {
    SampleTable samples{state.report.channels, {}, 1.0 / state.report.sample_rate_Hz};
    samples.columns.insert(samples.columns.begin(), {"run", "t"});
    for (const ImportedRun& run : state.report.runs) samples.run_numbers.push_back(run.number);
    const std::string place = state.mapping.file.empty() ? "mapping" : state.mapping.file + " [recording]";
    Recording recording =
        read_sidecar(nlohmann::json(imported_sidecar(state)), place, samples, state.problems);
    state.problems.throw_if_any();
    // The reader orders channels by the sidecar; here they follow the table.
    std::sort(recording.channels.begin(), recording.channels.end(), [&](const Channel& a, const Channel& b) {
        const auto place_of = [&](const Channel& channel) {
            return std::find(state.report.channels.begin(), state.report.channels.end(), channel.name);
        };
        return place_of(a) < place_of(b);
    });
    for (std::size_t index = 0; index < state.pieces.size(); ++index) {
        RecordedRun& run = recording.runs[index];
        run.values.assign(state.kept.size(), {});
        const Piece& piece = state.pieces[index];
        const double expected = (piece.to_s - piece.from_s) * state.report.sample_rate_Hz + 1.0;
        const auto every = static_cast<std::size_t>(
            std::max(1.0, std::ceil(expected / static_cast<double>(preview_samples))));
        std::size_t row = 0;
        const auto keep_some = [&](double time_s, std::span<const double> values) {
            if (row++ % every != 0) return;
            run.time_s.push_back(time_s);
            for (std::size_t k = 0; k < values.size(); ++k) run.values[k].push_back(values[k]);
        };
        state.report.runs[index].samples =
            for_each_row(state.logs.runs[piece.log_run], piece, state.kept, keep_some);
    }
    // As every reader has it: a model that is driven by noise slips where the bench stuck.
    return with_estimated_noise(std::move(recording));
}

}  // namespace capstan::imports
