#include <fmt/format.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>

#include "capstan/cli/answer_format.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/output.h"
#include "capstan/cli/usage_error.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/reports/diagnosis_report.h"
#include "capstan/reports/study_comparison.h"
#include "capstan/reports/study_report.h"
#include "capstan/storage/diagnosis_store.h"
#include "capstan/storage/error.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

std::string report_of(storage::Database& database, std::int64_t id, const std::string& format) {
    if (format == "md") return reports::study_report_markdown(database, id);
    if (format == "csv") return reports::study_error_csv(database, id);
    if (format == "json") return reports::study_report_json(database, id);
    return reports::study_report_html(database, id);
}

std::string comparison_of(storage::Database& database, const reports::ComparedStudies& studies,
                          const std::string& format) {
    if (format == "md") return reports::study_comparison_markdown(database, studies);
    if (format == "csv") return reports::study_comparison_csv(database, studies);
    if (format == "json") return reports::study_comparison_json(database, studies);
    return reports::study_comparison_html(database, studies);
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

std::string diagnosis_in(storage::Database& database, const std::string& name, const std::string& format) {
    const auto diagnosis = storage::load_diagnosis(database, diagnosis_named(database, name));
    if (format == "md") return reports::diagnosis_markdown(diagnosis);
    if (format == "csv") return reports::diagnosis_csv(diagnosis);
    if (format == "json") return json_text(reports::diagnosis_json(diagnosis));
    return reports::diagnosis_html(diagnosis);
}

std::string chosen_report(const Invocation& invocation, storage::Database& database,
                          const std::string& format) {
    if (invocation.has("diagnosis")) return diagnosis_in(database, invocation.text("diagnosis"), format);
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    if (!invocation.has("compare")) return report_of(database, id, format);
    return comparison_of(database, {storage::find_study(database, invocation.text("compare")), id}, format);
}

ExitCode run(const Invocation& invocation) {
    const std::string format = answer_format(invocation, "html");
    const std::string& file = invocation.text("output");
    if (invocation.has("diagnosis") && invocation.has("compare"))
        throw UsageError(
            "capstan report: --diagnosis is of a recording, --compare of two studies; name one of them");
    if (format == "html" && file == "-" && ::isatty(STDOUT_FILENO) == 1) {
        throw UsageError(
            "capstan report: a page of HTML is nothing for a terminal; name a file with -o report.html, or "
            "read it here with --format md");
    }
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    deliver(invocation, chosen_report(invocation, database, format));
    if (file != "-") say(fmt::format("Wrote {}.", file));
    return ExitCode::success;
}

}  // namespace

Command report_command() {
    return {
        "report",
        "Write a report: one HTML page, Markdown, CSV or JSON.",
        "Writes a study's report. The HTML page holds everything and needs no network: the recommendation first, "
        "then the figures and the data behind them. Markdown is for reading in a terminal, CSV is the error of every "
        "layout, count and method, JSON is every table. The same for a stored diagnosis: CSV has a line for every number, "
        "JSON is the answer of capstan diagnose --json.",
        {study_argument},
        {{"format",
          '\0',
          OptionKind::text,
          "html|md|csv|json",
          "Default: as FILE ends, else html.",
          "",
          {"html", "md", "csv", "json"}},
         {"compare", '\0', OptionKind::text, "OTHER",
          "Report on OTHER and STUDY beside each other: settings, advice, errors."},
         {"diagnosis", '\0', OptionKind::text, "NUMBER",
          "Report on a diagnosis that `capstan diagnose --db` kept: its number, or latest."},
         database_option,
         output_option,
         {"json", '\0', OptionKind::flag, "", "The same as --format json."},
         help_option},
        {"capstan report -o report.html", "capstan report paper --format md", "capstan report -o errors.csv",
         "capstan report --compare 1 2 -o comparison.html",
         "capstan report --diagnosis latest -o diagnosis.html"},
        run};
}

}  // namespace capstan::cli
