#include "capstan/import/importer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "capstan/cable/invalid_input.h"
#include "capstan/import/import_state.h"
#include "capstan/import/log_times.h"
#include "capstan/import/plausibility.h"
#include "capstan/platform/files.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/rig/channel_names.h"

namespace capstan::imports {

namespace {

constexpr std::size_t written_at_once_bytes = 1u << 18;

void tell(const ImportState& state, const char* activity, double fraction) {
    if (state.options.on_progress) state.options.on_progress(activity, fraction);
}

void check_time_unit(ImportState& state) {
    const Piece& piece = state.pieces.front();
    const double period_s = state.plans[piece.log_run].surveys.front().period_s;
    if (is_usual_period(period_s)) return;
    const double seconds = state.logs.runs[piece.log_run].sources.front().clock.seconds;
    const std::string_view likely = usual_time_unit(period_s / seconds);
    state.report.findings.push_back(
        {.kind = FindingKind::time_unit,
         .amount = period_s,
         .words =
             fmt::format("the times are read in {}, which gives a rate of {:.4g} Hz, unusual for a bench{}; "
                         "state time.unit",
                         time_unit_name(seconds), 1.0 / period_s,
                         likely.empty() ? "" : fmt::format("; in {} it would be usual", likely))});
}

void survey_runs(ImportState& state) {
    plan_runs(state, state.report.findings);
    if (state.pieces.empty()) {
        std::vector<std::string> words = {fmt::format(
            "no run is left: the log has no stretch of {} samples in which every channel has readings",
            min_run_samples)};
        for (const Finding& finding : state.report.findings) words.push_back(finding.words);
        throw InvalidInput(words);
    }
    check_time_unit(state);
}

// As the mapping's runs say, or as is usual for the kind of bench.
bool is_driven(const ImportState& state, const std::string& channel) {
    const auto lists = [&](const auto& driven) {
        return std::find(driven.begin(), driven.end(), channel) != driven.end();
    };
    const auto mode = state.mapping.recording.is_object() && state.mapping.recording.contains("mode") &&
                              state.mapping.recording["mode"].is_string()
                          ? mode_named(state.mapping.recording["mode"].get<std::string>())
                          : std::nullopt;
    if (mode && lists(usual_driven_channels(*mode))) return true;
    return std::any_of(state.mapping.runs.begin(), state.mapping.runs.end(), [&](const RunMapping& run) {
        return run.conditions.is_object() && run.conditions.contains("driven") &&
               lists(run.conditions["driven"]);
    });
}

void leave_out_constant_channels(ImportState& state) {
    for (std::size_t channel = 0; channel < state.mapping.channels.size(); ++channel) {
        const bool constant =
            std::all_of(state.plans.begin(), state.plans.end(), [&](const StretchPlan& plan) {
                return plan.surveys.empty() || plan.surveys[channel].constant();
            });
        const std::string& name = state.mapping.channels[channel].name;
        if (constant && name != channel::load_angle &&
            !is_driven(state, name)) {  // a lock may hold perfectly
            state.report.findings.push_back(
                {.kind = FindingKind::constant_channel,
                 .repaired = true,
                 .channel = name,
                 .words = fmt::format(
                     "{} never changes; a sensor that is not connected? The channel is left out", name)});
        } else {
            state.kept.push_back(channel);
            state.report.channels.push_back(name);
        }
    }
    if (state.kept.empty()) throw InvalidInput({"every channel is constant: nothing moves in this log"});
}

void refuse_repairs(const ImportState& state) {
    if (!state.options.strict) return;
    std::vector<std::string> refused;
    for (const Finding& finding : state.report.findings) {
        if (finding.repaired || finding.kind == FindingKind::unread) refused.push_back(finding.words);
    }
    if (refused.empty()) return;
    refused.insert(refused.begin(),
                   "--strict repairs nothing, and this log needs it; correct the log or the mapping, or "
                   "import without --strict:");
    throw InvalidInput(refused);
}

// With what was found, which may say why.
void refuse_what_no_reader_takes(ImportState& state) {
    check_recording(state.report.recording, "the recording", state.problems);
    if (state.problems.empty()) return;
    std::vector<std::string> words = state.problems.listed(SIZE_MAX);
    for (const Finding& finding : state.report.findings) {
        if (!finding.repaired && finding.kind != FindingKind::assumed) words.push_back(finding.words);
    }
    throw InvalidInput(words);
}

void append_row(std::string& text, int run, double time_s, std::span<const double> values) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{},{:.10g}", run, time_s);
    for (const double value : values) fmt::format_to(out, ",{:.9g}", value);
    text += '\n';
}

ImportState prepared(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                     const ImportOptions& options) {
    ImportState state{mapping, options};
    for (const auto& file : files) state.report.files.push_back(file.filename().string());
    const auto on_read = [&](double part) { tell(state, "reading", part); };
    state.logs = read_log_runs(files, mapping, on_read, state.problems);
    state.report.findings = state.logs.findings;
    survey_runs(state);
    leave_out_constant_channels(state);
    number_runs(state);
    align_clocks(state);
    state.report.recording = preview_recording(state);
    std::vector<Finding>& findings = state.report.findings;
    for (Finding& doubt : doubts_of(state.report.recording)) findings.push_back(std::move(doubt));
    for (const std::string& assumption : state.report.recording.assumptions)
        findings.push_back({.kind = FindingKind::assumed, .words = assumption});
    refuse_repairs(state);
    return state;
}

// The samples and their description appear under their names together, when both are complete.
void write(ImportState& state, const std::filesystem::path& name) {
    const RecordingPaths paths = recording_paths(name);
    for (const auto& log : state.logs.logs) {
        std::error_code none;
        if (std::filesystem::equivalent(log->file, paths.samples, none) ||
            std::filesystem::equivalent(log->file, paths.sidecar, none))
            throw InvalidInput({fmt::format("{}: is one of the logs; give the recording another name with -o",
                                            log->file.string())});
    }
    refuse_what_no_reader_takes(state);
    AtomicFile samples(paths.samples);
    AtomicFile sidecar(paths.sidecar);
    samples.append("run,t," + fmt::format("{}", fmt::join(state.report.channels, ",")) + "\n");
    double written_s = 0.0;
    double all_s = 0.0;
    for (const Piece& piece : state.pieces) all_s += piece.to_s - piece.from_s;
    std::string text;
    for (std::size_t index = 0; index < state.pieces.size(); ++index) {
        const Piece& piece = state.pieces[index];
        const auto add_row = [&](double time_s, std::span<const double> values) {
            append_row(text, state.report.runs[index].number, time_s, values);
            if (text.size() < written_at_once_bytes) return;
            samples.append(text);
            text.clear();
            tell(state, "writing", all_s > 0.0 ? (written_s + time_s) / all_s : 1.0);
        };
        for_each_row(state.logs.runs[piece.log_run], piece, state.kept, add_row);
        written_s += piece.to_s - piece.from_s;
    }
    samples.append(text);
    sidecar.append(imported_sidecar(state).dump(2) + "\n");
    samples.finish();
    sidecar.finish();
}

}  // namespace

void plan_runs(ImportState& state, std::vector<Finding>& findings) {
    state.plans.clear();
    state.pieces.clear();
    for (std::size_t index = 0; index < state.logs.runs.size(); ++index) {
        state.plans.push_back(plan_stretch(state.logs.runs[index], index, state.mapping, findings));
        const StretchPlan& plan = state.plans.back();
        state.pieces.insert(state.pieces.end(), plan.pieces.begin(), plan.pieces.end());
        if (!plan.pieces.empty()) state.report.sample_rate_Hz = plan.sample_rate_Hz;
        tell(state, "checking", static_cast<double>(index + 1) / static_cast<double>(state.logs.runs.size()));
    }
}

ImportReport import_logs(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                         const std::filesystem::path& name, const ImportOptions& options) {
    ImportState state = prepared(files, mapping, options);
    state.report.recording.name = recording_paths(name).samples.stem().string();
    write(state, name);
    return std::move(state.report);
}

ImportReport try_import(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                        const ImportOptions& options) {
    return std::move(prepared(files, mapping, options).report);
}

}  // namespace capstan::imports
