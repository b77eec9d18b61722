#include <fmt/format.h>

#include <cmath>

#include "capstan/reports/figure_html.h"
#include "capstan/reports/html_text.h"
#include "capstan/reports/page_data.h"
#include "capstan/reports/page_frame.h"
#include "capstan/reports/recommendation_section.h"
#include "capstan/reports/study_report.h"
#include "capstan/reports/table.h"
#include "capstan/storage/report_queries.h"

namespace capstan::reports {
namespace {

struct Section {
    const char* id;  // as the figures' specs name it
    const char* title;
    const char* intro;
};

// In the order of the page, between the recommendation and how the study was made.
constexpr Section figure_sections[] = {
    {"one-sensor", "Single sensors",
     "One noisy reading and the motor's position give the tension profile of the cable. How accurate it is depends on "
     "where the "
     "sensor sits and on whether the direction of motion is known."},
    {"fusion", "Several sensors",
     "The same readings, fused. Every method sees the same draws, so lines may be compared more closely than "
     "their "
     "bands suggest."},
    {"doubt", "Caveats",
     "How often the direction of motion is uncertain, and at which node the error of the recommended layout is largest."},
};

std::string each_figure(const StudyTables& tables, const char* section) {
    std::string html;
    for (const Figure& figure : figures()) {
        if (figure.page != "study" || figure.section != section) continue;
        if (figure.per == "study") html += figure_html(tables, figure, {});
        if (figure.per != "regime") continue;
        for (const Row& regime : tables["regime"].each())
            html += figure_html(tables, figure, {regime.text("regime")});
    }
    return html;
}

std::string signed_number(double value) {
    if (value == 0) return "0";
    return (value < 0 ? "&minus;" : "+") + plain_number(std::abs(value), std::abs(value) < 1 ? 2 : 3);
}

std::string paper_section(const StudyTables& tables) {
    const Table& table = tables["paper_comparison"];
    if (table.empty()) return "";
    std::string rows;
    for (const Row& row : table.each()) {
        const auto paper_N = row.maybe_number("paper_N");
        const auto difference_N = row.maybe_number("difference_N");
        rows += fmt::format(
            "<tr><th scope=\"row\">{}</th><td class=\"number\">{}{}</td><td class=\"number\">{} "
            "<small>&plusmn; {}</small></td>"
            "<td class=\"number\">{}</td><td>{}</td></tr>\n",
            escape_html(row.text("quantity")), paper_N && row.text("relation") == "<" ? "&lt; " : "",
            paper_N ? plain_number(*paper_N) : "&ndash;", plain_number(row.number("ours_N")),
            plain_number(row.number("interval_high_N") - row.number("ours_N"), 2),
            difference_N ? signed_number(*difference_N) : "&ndash;", escape_html(row.text("reason")));
    }
    const std::string html =
        each_figure(tables, "paper") +
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"The paper and this study\">"
        "<table><caption>Mean absolute tension error</caption><thead><tr><th scope=\"col\">Quantity</th><th scope=\"col\">Paper [N]</th>"
        "<th scope=\"col\">Here [N] &plusmn; half width of the 95% interval</th><th scope=\"col\">Difference [N]</th>"
        "<th scope=\"col\">Why</th>"
        "</tr></thead><tbody>\n" +
        rows + "</tbody></table></div>\n";
    return section_html(
        "paper", "The paper's numbers and ours",
        escape_html(std::string(storage::paper_matched_words) + " " + storage::paper_agreement_words()),
        html);
}

std::string method_list(const StudyTables& tables) {
    std::string items;
    for (const Row& method : tables["fusion_method"].each()) {
        items += fmt::format("<li><b>{}</b>: {}</li>\n", escape_html(method.text("title")),
                             escape_html(method.text("meaning")));
    }
    return items.empty() ? "" : "<h3>Fusion methods</h3>\n<ul>\n" + items + "</ul>\n";
}

std::string duty_in_words(const StudyTables& tables) {
    std::string words;
    for (const Row& regime : tables["regime"].each()) {
        words += fmt::format("{}{} {} of the working time ({} {})", words.empty() ? "" : "; ",
                             escape_html(regime_title(regime.text("regime"))),
                             percent(regime.number("duty_fraction")), regime.integer("instants"),
                             regime.integer("instants") == 1 ? "instant" : "instants");
    }
    return words;
}

std::string making_section(const StudyTables& tables) {
    const Row study = tables.study();
    std::string html = fmt::format(
        R"(<dl class="facts">
<div><dt>Program</dt><dd>capstan {}</dd></div>
<div><dt>Seed</dt><dd>{}</dd></div>
<div><dt>Repetitions</dt><dd>{} per instant and noise level</dd></div>
<div><dt>Cable</dt><dd>{} segments, {} nodes</dd></div>
<div class="wide"><dt>Regimes</dt><dd>{}</dd></div>
</dl>
)",
        escape_html(study.text("program_version")), static_cast<std::uint64_t>(study.integer("seed")),
        study.integer("repetitions"), study.integer("segments"), study.integer("segments") + 1,
        duty_in_words(tables));
    html += method_list(tables);
    html +=
        "<details class=\"config\"><summary>Configuration, every key written out</summary><pre "
        "tabindex=\"0\">" +
        escape_html(study.text("config_toml")) + "</pre></details>\n";
    html +=
        "<h3>All tables</h3>\n<p>Six significant digits; the database has them all.</p>\n<ul "
        "id=\"downloads\"></ul>\n";
    return section_html(
        "making", "How the study was made",
        "The same program, configuration and seed give the same numbers, on any number of threads.", html);
}

std::string noise_selector(const StudyTables& tables) {
    const auto levels = tables["noise_level"].each();
    if (levels.size() < 2) return "";
    std::string html = "<fieldset id=\"noise\"><legend>Sensor noise</legend>\n";
    bool first = true;
    for (const Row& level : levels) {
        html += fmt::format(
            "<label><input type=\"radio\" name=\"noise\" value=\"{}\"{}><span>{}</span></label>\n",
            level.integer("noise_level_id"), first ? " checked" : "", escape_html(level.text("label")));
        first = false;
    }
    return html + "</fieldset>\n";
}

std::string navigation(const std::string& main_html, const StudyTables& tables) {
    std::vector<SectionLink> links = {{"recommendation", "Recommendations"}};
    for (const Section& section : figure_sections) links.push_back({section.id, section.title});
    links.push_back({"paper", "The paper and ours"});
    links.push_back({"making", "Settings"});
    return navigation_html(main_html, links, noise_selector(tables));
}

std::string study_html(storage::Database& database, std::int64_t study_id, PageFiles files) {
    const StudyTables tables(database, study_id);
    const Row study = tables.study();

    std::string main_html = recommendation_section(tables);
    for (const Section& section : figure_sections) {
        main_html += section_html(section.id, section.title, section.intro, each_figure(tables, section.id));
    }
    main_html += paper_section(tables) + making_section(tables);

    PageFrame frame;
    frame.document_title = study.text("name") + " – capstan report";
    frame.kind = "Sensor placement study";
    frame.title = study.text("name");
    frame.verdict = verdict(tables);
    frame.navigation_html = navigation(main_html, tables);
    frame.main_html = std::move(main_html);
    frame.footer = fmt::format("Made by capstan {} from study {}.", study.text("program_version"),
                               study.integer("study_id"));
    frame.data_json = page_data(tables, "study");
    return page_html(frame, files);
}

}  // namespace

std::string study_report_html(storage::Database& database, std::int64_t study_id) {
    return study_html(database, study_id, PageFiles::inside);
}

std::string study_live_html(storage::Database& database, std::int64_t study_id) {
    return study_html(database, study_id, PageFiles::served);
}

}  // namespace capstan::reports
