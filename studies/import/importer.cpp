#include "capstan/import/importer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "capstan/cable/invalid_input.h"
#include "capstan/import/import_state.h"
#include "capstan/import/plausibility.h"
#include "capstan/platform/files.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/rig/channel_names.h"

namespace capstan::imports {

namespace {

constexpr double longest_usual_period_s = 0.1;
constexpr double shortest_usual_period_s = 5e-5;

void tell(const ImportState& import, const char* activity, double fraction) {
    if (import.options.on_progress) import.options.on_progress(activity, fraction);
}

void check_time_unit(ImportState& import) {
    double period_s = 0.0;
    for (const StretchPlan& plan : import.plans) {
        if (!plan.surveys.empty()) period_s = plan.surveys.front().period_s;
    }
    if (period_s <= longest_usual_period_s && period_s >= shortest_usual_period_s) return;
    const bool slow = period_s > longest_usual_period_s;
    import.report.findings.push_back(
        {.kind = FindingKind::time_unit,
         .amount = period_s,
         .words = fmt::format(
             "the log's rate is {:.4g} Hz by its times, {} for a bench; are the times in {} "
             "rather than in {}? State time.unit",
             1.0 / period_s, slow ? "very slow" : "very fast", slow ? "ms" : "s",
             import.mapping.time.unit.empty() ? "the unit that was assumed" : import.mapping.time.unit)});
}

void survey_runs(ImportState& import) {
    plan_runs(import, import.report.findings);
    if (import.pieces.empty()) {
        std::vector<std::string> words = {
            "no run is left: the log has no stretch of 20 samples in which every channel "
            "has readings"};
        for (const Finding& finding : import.report.findings) words.push_back(finding.words);
        throw InvalidInput(words);
    }
    check_time_unit(import);
}

// As the mapping's runs say, or as is usual for the kind of bench.
bool is_driven(const ImportState& import, const std::string& channel) {
    const auto lists = [&](const auto& driven) {
        return std::find(driven.begin(), driven.end(), channel) != driven.end();
    };
    const auto mode = import.mapping.recording.is_object() && import.mapping.recording.contains("mode") &&
                              import.mapping.recording["mode"].is_string()
                          ? mode_named(import.mapping.recording["mode"].get<std::string>())
                          : std::nullopt;
    if (mode && lists(usual_driven_channels(*mode))) return true;
    return std::any_of(import.mapping.runs.begin(), import.mapping.runs.end(), [&](const RunMapping& run) {
        return run.conditions.is_object() && run.conditions.contains("driven") &&
               lists(run.conditions["driven"]);
    });
}

void leave_out_constant_channels(ImportState& import) {
    for (std::size_t channel = 0; channel < import.mapping.channels.size(); ++channel) {
        const bool constant =
            std::all_of(import.plans.begin(), import.plans.end(), [&](const StretchPlan& plan) {
                return plan.surveys.empty() || plan.surveys[channel].constant();
            });
        const std::string& name = import.mapping.channels[channel].name;
        if (constant && name != channel::load_angle &&
            !is_driven(import, name)) {  // a lock may hold perfectly
            import.report.findings.push_back(
                {.kind = FindingKind::constant_channel,
                 .repaired = true,
                 .channel = name,
                 .words = fmt::format(
                     "{} never changes; a sensor that is not connected? The channel is left out", name)});
        } else {
            import.kept.push_back(channel);
            import.report.channels.push_back(name);
        }
    }
    if (import.kept.empty()) throw InvalidInput({"every channel is constant: nothing moves in this log"});
}

void refuse_repairs(const ImportState& import) {
    if (!import.options.strict) return;
    std::vector<std::string> refused;
    for (const Finding& finding : import.report.findings) {
        if (finding.repaired || finding.kind == FindingKind::unread) refused.push_back(finding.words);
    }
    if (refused.empty()) return;
    refused.insert(refused.begin(),
                   "--strict repairs nothing, and this log needs it; correct the log or the mapping, or "
                   "import without --strict:");
    throw InvalidInput(refused);
}

// With what was found, which may say why.
void refuse_what_no_reader_takes(ImportState& import) {
    check_recording(import.report.recording, "the recording", import.problems);
    if (import.problems.empty()) return;
    std::vector<std::string> words = import.problems.listed(SIZE_MAX);
    for (const Finding& finding : import.report.findings) {
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
    ImportState import{mapping, options};
    for (const auto& file : files) import.report.files.push_back(file.filename().string());
    import.logs = read_log_runs(
        files, mapping, [&](double part) { tell(import, "reading", part);
}, import.problems);
import.report.findings = import.logs.findings;
survey_runs(import);
leave_out_constant_channels(import);
number_runs(import);
align_clocks(import);
import.report.recording = preview_recording(import);
std::vector<Finding>& findings = import.report.findings;
for (Finding& doubt : doubts_of(import.report.recording)) findings.push_back(std::move(doubt));
for (const std::string& assumption : import.report.recording.assumptions)
    findings.push_back({.kind = FindingKind::assumed, .words = assumption});
refuse_repairs(import);
return import;
}  // namespace

void write(ImportState& import, const std::filesystem::path& name) {
    std::filesystem::path samples = name;
    std::filesystem::path sidecar = name;
    if (name.extension() != ".csv" && name.extension() != ".json") {
        samples += ".csv";
        sidecar += ".json";
    } else {
        samples.replace_extension(".csv");
        sidecar.replace_extension(".json");
    }
    if (std::find(import.report.files.begin(), import.report.files.end(), samples.filename().string()) !=
            import.report.files.end() &&
        std::filesystem::exists(samples))
        throw InvalidInput({fmt::format("{}: is one of the logs; give the recording another name with -o",
                                        samples.string())});
    refuse_what_no_reader_takes(import);
    AtomicFile file(samples);
    file.append("run,t," + fmt::format("{}", fmt::join(import.report.channels, ",")) + "\n");
    double written_s = 0.0;
    double all_s = 0.0;
    for (const Piece& piece : import.pieces) all_s += piece.to_s - piece.from_s;
    std::string text;
    for (std::size_t index = 0; index < import.pieces.size(); ++index) {
        const Piece& piece = import.pieces[index];
        for_each_row(import.logs.runs[piece.log_run], piece, import.kept,
                     [&](double time_s, std::span<const double> values) {
                         append_row(text, import.report.runs[index].number, time_s, values);
                         if (text.size() < 1u << 18) return;
                         file.append(text);
                         text.clear();
                         tell(import, "writing", all_s > 0.0 ? (written_s + time_s) / all_s : 1.0);
                     });
        written_s += piece.to_s - piece.from_s;
    }
    file.append(text);
    const std::string description = imported_sidecar(import).dump(2) + "\n";
    file.finish();
    write_file(sidecar, description);
}

}  // namespace capstan::imports

void plan_runs(ImportState& import, std::vector<Finding>& findings) {
    import.plans.clear();
    import.pieces.clear();
    for (std::size_t index = 0; index < import.logs.runs.size(); ++index) {
        import.plans.push_back(plan_stretch(import.logs.runs[index], index, import.mapping, findings));
        const StretchPlan& plan = import.plans.back();
        import.pieces.insert(import.pieces.end(), plan.pieces.begin(), plan.pieces.end());
        if (!plan.pieces.empty()) import.report.sample_rate_Hz = plan.sample_rate_Hz;
        tell(import, "checking",
             static_cast<double>(index + 1) / static_cast<double>(import.logs.runs.size()));
    }
}

ImportReport import_logs(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                         const std::filesystem::path& name, const ImportOptions& options) {
    ImportState import = prepared(files, mapping, options);
    write(import, name);
    return std::move(import.report);
}

ImportReport try_import(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                        const ImportOptions& options) {
    return std::move(prepared(files, mapping, options).report);
}

}  // namespace capstan::imports
