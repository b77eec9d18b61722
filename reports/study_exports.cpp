#include <fmt/format.h>

#include "capstan/reports/html_text.h"
#include "capstan/reports/plain_tables.h"
#include "capstan/reports/recommendation_section.h"
#include "capstan/reports/study_report.h"
#include "capstan/reports/table.h"
#include "capstan/storage/report_queries.h"

namespace capstan::reports {
namespace {

std::string recommendations_markdown(const StudyTables& tables) {
    const auto rows = tables["recommendation"].each();
    if (rows.empty()) return "";
    std::string text =
        "## Recommendations\n\n| Scope | Noise | Sensors | Nodes | Method | Objective | [N] | 95% interval |\n"
        "| --- | --- | ---: | --- | --- | --- | ---: | --- |\n";
    std::string sentences;
    for (const Row& row : rows) {
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", recommendation_title(row),
                            escape_markdown(row.text("noise")), row.integer("sensor_count"),
                            escape_markdown(row.text("nodes")), escape_markdown(row.text("method_title")),
                            objective_title(row), plain_number(row.number("error_N")),
                            newtons_between(row.number("interval_low_N"), row.number("interval_high_N")));
        sentences += fmt::format("- {} ({}): {}\n", recommendation_title(row),
                                 escape_markdown(row.text("noise")), escape_markdown(row.text("sentence")));
    }
    return text + "\n" + sentences + "\n";
}

std::string errors_markdown(const StudyTables& tables) {
    const auto rows = tables["error_by_layout"].each();
    if (rows.empty()) return "";
    std::string text =
        "## Error by layout, number of sensors and method\n\n"
        "| Regime | Noise | Layout | Sensors | Method | Mean error [N] | 95% interval |\n"
        "| --- | --- | --- | ---: | --- | ---: | --- |\n";
    for (const Row& row : rows) {
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", regime_title(row.text("regime")),
                            escape_markdown(row.text("noise")), escape_markdown(row.text("family")),
                            row.integer("sensor_count"), escape_markdown(row.text("method_title")),
                            plain_number(row.number("mean_abs_error_N")),
                            newtons_between(row.number("interval_low_N"), row.number("interval_high_N")));
    }
    return text + "\n";
}

std::string paper_markdown(const StudyTables& tables) {
    const auto rows = tables["paper_comparison"].each();
    if (rows.empty()) return "";
    std::string text =
        "## The paper's numbers and ours\n\n| Quantity | Paper [N] | Here [N] | Difference [N] | Why |\n"
        "| --- | ---: | ---: | ---: | --- |\n";
    for (const Row& row : rows) {
        const auto paper_N = row.maybe_number("paper_N");
        const auto difference_N = row.maybe_number("difference_N");
        text +=
            fmt::format("| {} | {}{} | {} | {} | {} |\n", escape_markdown(row.text("quantity")),
                        paper_N && row.text("relation") == "<" ? "&lt; " : "",
                        paper_N ? plain_number(*paper_N) : "", plain_number(row.number("ours_N")),
                        difference_N ? plain_number(*difference_N) : "", escape_markdown(row.text("reason")));
    }
    return text + "\n" + storage::paper_matched_words + " " + storage::paper_agreement_words() + "\n\n";
}

}  // namespace

std::string study_report_markdown(storage::Database& database, std::int64_t study_id) {
    const StudyTables tables(database, study_id);
    const Row study = tables.study();
    return fmt::format("# {}\n\n{}\n\n", escape_markdown(study.text("name")),
                       escape_markdown(verdict(tables))) +
           recommendations_markdown(tables) + errors_markdown(tables) + paper_markdown(tables) +
           fmt::format("Made by capstan {}, seed {}, {} repetitions.\n", study.text("program_version"),
                       static_cast<std::uint64_t>(study.integer("seed")), study.integer("repetitions"));
}

std::string study_report_json(storage::Database& database, std::int64_t study_id) {
    const StudyTables tables(database, study_id);
    return tables_json(tables.all());
}

std::string study_error_csv(storage::Database& database, std::int64_t study_id) {
    const StudyTables tables(database, study_id);
    const Table& errors = tables["error_by_layout"];
    return csv_text(errors.columns, errors.rows);
}

}  // namespace capstan::reports
