#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/usage_error.h"
#include "capstan/reports/study_comparison.h"
#include "capstan/reports/study_report.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

// As asked for, else as the file's name ends, else HTML.
std::string format_of(const Invocation& invocation) {
    if (invocation.has("json")) return "json";
    if (invocation.has("format")) return invocation.text("format");
    const std::string ending = std::filesystem::path(invocation.text("output")).extension().string();
    for (const char* known : {"md", "csv", "json"}) {
        if (ending == std::string(".") + known) return known;
    }
    return "html";
}

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

ExitCode run(const Invocation& invocation) {
    const std::string format = format_of(invocation);
    const std::string& file = invocation.text("output");
    if (format == "html" && file == "-" && ::isatty(STDOUT_FILENO) == 1) {
        throw UsageError(
            "capstan report: a page of HTML is nothing for a terminal; name a file with -o report.html, or "
            "read it here with --format md");
    }
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    if (invocation.has("compare")) {
        const std::int64_t first = storage::find_study(database, invocation.text("compare"));
        deliver(invocation, comparison_of(database, {first, id}, format));
    } else {
        deliver(invocation, report_of(database, id, format));
    }
    if (file != "-") fmt::print(stderr, "Wrote {}.\n", file);
    return ExitCode::success;
}

}  // namespace

Command report_command() {
    return {
        "report",
        "Write a report: one HTML page, Markdown, CSV or JSON.",
        "Writes a study's report. The HTML page holds everything and needs no network: the recommendation first, "
        "then the figures and the data behind them. Markdown is for reading in a terminal, CSV is the error of every "
        "layout, count and method, JSON is every table.",
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
         database_option,
         output_option,
         {"json", '\0', OptionKind::flag, "", "The same as --format json."},
         help_option},
        {"capstan report -o report.html", "capstan report paper --format md", "capstan report -o errors.csv",
         "capstan report --compare 1 2 -o comparison.html"},
        run};
}

}  // namespace capstan::cli
