#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "capstan/answers/placement_answers.h"
#include "capstan/answers/recording_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/watched_run.h"
#include "capstan/placement/stored_study.h"
#include "capstan/platform/parsed_number.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/printing/printed_page.h"
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
    if (const auto number = parsed_number<std::int64_t>(name)) return *number;
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
    if (!invocation.has("other-db")) {
        const std::int64_t other = storage::find_study(database, invocation.text("compare"));
        return answer_in(reports::study_comparison({database, other}, {database, id}), format);
    }
    storage::Database other_database = storage::Database::open_read_only(invocation.text("other-db"));
    const std::int64_t other = storage::find_study(other_database, invocation.text("compare"));
    refuse_worlds(load_stored_study(other_database, other).plan, "--compare");
    return answer_in(reports::study_comparison({other_database, other}, {database, id}), format);
}

bool ends_in_pdf(const std::string& file) {
    return std::filesystem::path(file).extension() == ".pdf";
}

void require_browser(std::string_view option) {
    if (printing::browser_on_path().empty())
        throw UsageError(fmt::format(
            "capstan report: {} needs a browser such as chromium on PATH (Debian: apt-get install "
            "chromium), and there is none. Write -o report.html, and print or save from a browser",
            option));
}

void write_figures(const Invocation& invocation, const std::string& page) {
    const std::filesystem::path folder = invocation.text("figures");
    ShownWork work(invocation, "drawing the figures");
    const auto figures = printing::figures_of(page, invocation.count("width"));
    work.end();
    std::filesystem::create_directories(folder);
    for (const printing::FigureFile& figure : figures) write_file(folder / figure.name, figure.bytes);
    say(fmt::format("Wrote {} figures, each as SVG and PNG, to {}.", figures.size() / 2, folder.string()));
}

std::string printed(const Invocation& invocation, const std::string& page) {
    ShownWork work(invocation, "printing");
    std::string pdf = printing::pdf_of(page);
    work.end();
    return pdf;
}

ExitCode run_report(const Invocation& invocation) {
    const std::string& file = invocation.text("output");
    const bool as_pdf = ends_in_pdf(file) && !invocation.has("format") && !invocation.has("json");
    const bool figures_only = invocation.has("figures") && file == "-";
    if (as_pdf) require_browser("-o " + file);
    if (invocation.has("figures")) require_browser("--figures");
    const AnswerFormat format =
        as_pdf || figures_only ? AnswerFormat::html : answer_format(invocation, AnswerFormat::html);
    if (invocation.has("other-db") && !invocation.has("compare"))
        throw UsageError(
            "capstan report: --other-db FILE names the database of --compare OTHER, which is missing");
    if (invocation.has("diagnosis") && invocation.has("compare"))
        throw UsageError(
            "capstan report: --diagnosis reports on a recording, --compare on two studies; give only one "
            "of them");
    if (format == AnswerFormat::html && file == "-" && !figures_only && ::isatty(STDOUT_FILENO) == 1) {
        throw UsageError(
            "capstan report: a terminal cannot show an HTML page; name a file with -o report.html, or "
            "read the report here with --format md");
    }
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    if (invocation.has("figures"))
        write_figures(invocation, chosen_report(invocation, database, AnswerFormat::html));
    if (figures_only) return ExitCode::success;
    const std::string text = chosen_report(invocation, database, format);
    deliver(invocation, as_pdf ? printed(invocation, text) : text);
    if (file != "-") say(fmt::format("Wrote {}.", file));
    return ExitCode::success;
}

}  // namespace

Command report_command() {
    return {
        .name = "report",
        .summary = "Write a report: one HTML page, PDF, Markdown, CSV or JSON; or its figures.",
        .description =
            "Writes a study's report. The HTML page is self-contained and needs no network: it shows the "
            "recommendation first, then the figures and their data. Markdown can be read in a terminal, "
            "CSV has the error of every layout, count and method, and JSON has every table. Reports on a "
            "stored diagnosis have the same formats: CSV has one line per number, and JSON is the answer "
            "of `capstan diagnose --json`. A file that ends in .pdf is the page as a browser prints it. --figures "
            "writes every figure as SVG and PNG, in the colours of print. Both take some seconds and need "
            "chromium or chrome.",
        .arguments = {study_argument},
        .options = {{.name = "format",
                     .meaning = "Default: by the extension of FILE, otherwise html.",
                     .choices = {"html", "md", "csv", "json"}},
                    {.name = "compare",
                     .value = "OTHER",
                     .meaning = "Compare OTHER and STUDY: settings, recommendations, errors."},
                    {.name = "other-db",
                     .value = "FILE",
                     .meaning = "The database that holds OTHER. Default: that of STUDY."},
                    {.name = "diagnosis",
                     .value = "NUMBER",
                     .meaning =
                         "Report on a diagnosis stored by `capstan diagnose --db`: its number, or latest."},
                    {.name = "figures",
                     .value = "FOLDER",
                     .meaning = "Write every figure to FOLDER, as SVG and PNG."},
                    {.name = "width",
                     .kind = OptionKind::integer,
                     .value = "PIXELS",
                     .meaning = "Width of these figures; an inch has 96. A PNG has four times as many.",
                     .default_value = "700",
                     .limits = {printing::smallest_width_px, printing::largest_width_px}},
                    database_option,
                    output_option,
                    {.name = "json", .meaning = "The same as --format json."},
                    progress_option,
                    help_option},
        .examples = {"capstan report -o report.html", "capstan report -o report.pdf",
                     "capstan report --figures figures --width 340", "capstan report paper --format md",
                     "capstan report -o errors.csv", "capstan report --compare 1 2 -o comparison.html",
                     "capstan report latest --compare latest --other-db older.db -o comparison.html",
                     "capstan report --diagnosis latest -o diagnosis.html"},
        .run = run_report,
        .time =
            "Less than 2 s; as PDF and with --figures about half a second for each figure, which the browser takes. Shows "
            "progress and the time left."};
}

}  // namespace capstan::cli
