#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>

#include "capstan/answers/placement_answers.h"
#include "capstan/answers/recording_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/watched_run.h"
#include "capstan/placement/stored_study.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/reports/study_comparison.h"
#include "capstan/reports/study_report.h"
#include "capstan/storage/diagnosis_store.h"
#include "capstan/storage/error.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

using reports::AnswerFormat;

std::string study_report(storage::Database& database, std::int64_t id, AnswerFormat format) {
    switch (format) {
        case AnswerFormat::markdown:
        case AnswerFormat::text:
            return reports::study_report_markdown(database, id);
        case AnswerFormat::csv:
            return reports::study_error_csv(database, id);
        case AnswerFormat::json:
            return reports::study_report_json(database, id);
        case AnswerFormat::html:
            break;
    }
    return reports::study_report_html(database, id);
}

std::int64_t diagnosis_named(storage::Database& database, const std::string& name) {
    std::int64_t number = 0;
    const auto [end, problem] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (problem == std::errc() && end == name.data() + name.size()) return number;
    if (name != "latest")
        throw UsageError(
            fmt::format("capstan report: --diagnosis '{}' is neither a number nor latest", name));
    const auto stored = storage::list_diagnoses(database);
    if (stored.empty())
        throw storage::Error(
            fmt::format("{} holds no diagnosis yet; `capstan diagnose LOG --db {}` makes one.",
                        database.path().string(), database.path().string()));
    return stored.back().diagnosis_id;
}

std::string chosen_report(const Invocation& invocation, storage::Database& database, AnswerFormat format) {
    if (invocation.has("diagnosis")) {
        const auto stored =
            storage::load_diagnosis(database, diagnosis_named(database, invocation.text("diagnosis")));
        return answer_in(answers::stored_diagnosis_answer(stored), format);
    }
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    const StoredStudy stored = load_stored_study(database, id);
    if (invocation.has("compare")) refuse_worlds(stored.plan, "--compare");
    if (stored.plan.uncertainty.is_stated)
        return answer_in(answers::conclusions_answer(database, id), format);
    if (!invocation.has("compare")) return study_report(database, id, format);
    const std::int64_t other = storage::find_study(database, invocation.text("compare"));
    return answer_in(reports::study_comparison(database, {other, id}), format);
}

ExitCode run_report(const Invocation& invocation) {
    const AnswerFormat format = answer_format(invocation, AnswerFormat::html);
    const std::string& file = invocation.text("output");
    if (invocation.has("diagnosis") && invocation.has("compare"))
        throw UsageError(
            "capstan report: --diagnosis reports on a recording, --compare on two studies; give only one "
            "of them");
    if (format == AnswerFormat::html && file == "-" && ::isatty(STDOUT_FILENO) == 1) {
        throw UsageError(
            "capstan report: a terminal cannot show an HTML page; name a file with -o report.html, or "
            "read the report here with --format md");
    }
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    deliver(invocation, chosen_report(invocation, database, format));
    if (file != "-") say(fmt::format("Wrote {}.", file));
    return ExitCode::success;
}

}  // namespace

Command report_command() {
    return {
        .name = "report",
        .summary = "Write a report: one HTML page, Markdown, CSV or JSON.",
        .description =
            "Writes a study's report. The HTML page is self-contained and needs no network: it shows the "
            "recommendation first, then the figures and their data. Markdown can be read in a terminal, "
            "CSV has the error of every layout, count and method, and JSON has every table. Reports on a "
            "stored diagnosis have the same formats: CSV has one line per number, and JSON is the answer "
            "of `capstan diagnose --json`.",
        .arguments = {study_argument},
        .options = {{.name = "format",
                     .value = "html|md|csv|json",
                     .meaning = "Default: by the extension of FILE, otherwise html.",
                     .choices = {"html", "md", "csv", "json"}},
                    {.name = "compare",
                     .value = "OTHER",
                     .meaning = "Compare OTHER and STUDY: settings, recommendations, errors."},
                    {.name = "diagnosis",
                     .value = "NUMBER",
                     .meaning =
                         "Report on a diagnosis stored by `capstan diagnose --db`: its number, or latest."},
                    database_option,
                    output_option,
                    {.name = "json", .kind = OptionKind::flag, .meaning = "The same as --format json."},
                    help_option},
        .examples = {"capstan report -o report.html", "capstan report paper --format md",
                     "capstan report -o errors.csv", "capstan report --compare 1 2 -o comparison.html",
                     "capstan report --diagnosis latest -o diagnosis.html"},
        .run = run_report};
}

}  // namespace capstan::cli
