#include <fmt/format.h>

#include <cmath>

#include "capstan/reports/embedded_files.h"
#include "capstan/reports/figure_html.h"
#include "capstan/reports/html_text.h"
#include "capstan/reports/page_data.h"
#include "capstan/reports/recommendation_section.h"
#include "capstan/reports/study_report.h"
#include "capstan/reports/study_tables.h"

namespace capstan::reports {
namespace {

struct Section {
    const char* id;  // as the figures' specs name it
    const char* title;
    const char* intro;
};

// In the order of the page, between the recommendation and how the study was made.
constexpr Section figure_sections[] = {
    {"one-sensor", "What one sensor tells",
     "One noisy reading and the motor's position give a whole tension profile. How good it is depends on "
     "where the "
     "sensor sits and on whether the direction of motion is known."},
    {"fusion", "What several sensors tell",
     "The same readings, fused. Every method sees the same draws, so lines may be compared more closely than "
     "their "
     "bands suggest."},
    {"doubt", "Where to be careful",
     "How often an estimate is in doubt, and at which node the recommended sensors err most."},
};

std::string each_figure(const StudyTables& tables, const char* section) {
    std::string html;
    for (const Figure& figure : figures()) {
        if (figure.section != section) continue;
        if (figure.per == "study") html += figure_html(tables, figure, {});
        if (figure.per != "regime") continue;
        for (const Row& regime : tables["regime"].each())
            html += figure_html(tables, figure, {regime.text("regime")});
    }
    return html;
}

std::string section_html(const char* id, const char* title, const char* intro, const std::string& content) {
    if (content.empty()) return "";
    return fmt::format(
        "<section id=\"{0}\" aria-labelledby=\"{0}-title\">\n<h2 id=\"{0}-title\">{1}</h2>\n<p "
        "class=\"intro\">{2}</p>\n"
        "{3}</section>\n",
        id, escape_html(title), escape_html(intro), content);
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
        "<table><caption>Mean absolute tension error, with the half width of its 95% interval"
        "</caption><thead><tr><th scope=\"col\">Quantity</th><th scope=\"col\">Paper [N]</th>"
        "<th scope=\"col\">Here [N]</th><th scope=\"col\">Difference [N]</th><th scope=\"col\">Why</th>"
        "</tr></thead><tbody>\n" +
        rows + "</tbody></table></div>\n";
    return section_html("paper", "The paper's numbers and ours",
                        "Nothing was tuned to agree; where the two differ, the table says why.", html);
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
                             percent(regime.number("duty_share")), regime.whole("instants"),
                             regime.whole("instants") == 1 ? "instant" : "instants");
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
        escape_html(study.text("program_version")), static_cast<std::uint64_t>(study.whole("seed")),
        study.whole("repetitions"), study.whole("segments"), study.whole("segments") + 1,
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
            level.whole("noise_level_id"), first ? " checked" : "", escape_html(level.text("label")));
        first = false;
    }
    return html + "</fieldset>\n";
}

std::string navigation(const std::string& main_html, const StudyTables& tables) {
    std::string links;
    const auto link = [&](const std::string& id, const std::string& title) {
        if (main_html.find("<section id=\"" + id + "\"") == std::string::npos) return;
        links += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", id, escape_html(title));
    };
    link("recommendation", "What to do");
    for (const Section& section : figure_sections) link(section.id, section.title);
    link("paper", "The paper and ours");
    link("making", "How it was made");
    return "<nav aria-label=\"Sections\"><ul>\n" + links + "</ul>\n" + noise_selector(tables) + "</nav>\n";
}

std::string scripts() {
    std::string html;
    for (const char* name : {"vega.min.js", "vega-lite.min.js", "vega-embed.min.js", "page.js"}) {
        html += fmt::format("<script data-file=\"{}\">{}</script>\n", name, embedded_file(name));
    }
    return html;
}

}  // namespace

std::string study_report_html(storage::Database& database, std::int64_t study_id) {
    const StudyTables tables(database, study_id);
    const Row study = tables.study();

    std::string main_html = recommendation_section(tables);
    for (const Section& section : figure_sections) {
        main_html += section_html(section.id, section.title, section.intro, each_figure(tables, section.id));
    }
    main_html += paper_section(tables) + making_section(tables);

    const std::string name = escape_html(study.text("name"));
    // The policy holds the page to its promise: it loads nothing.
    std::string page = fmt::format(
        R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline' 'unsafe-eval'; img-src data: blob:">
<title>{} – capstan report</title>
<style>
{}</style>
</head>
<body>
<a class="skip" href="#content">Skip to the content</a>
<header>
<p class="kind">Sensor placement study</p>
<h1>{}</h1>
<p class="verdict">{}</p>
</header>
)",
        name, embedded_file("page.css"), name, escape_html(verdict(tables)));
    page += navigation(main_html, tables);
    page +=
        "<main id=\"content\" tabindex=\"-1\">\n<noscript><p>The figures need JavaScript; the words and "
        "tables do not.</p></noscript>\n";
    page += main_html + "</main>\n";
    page +=
        fmt::format("<footer><p>Made by capstan {} from study {}. This page needs no network.</p></footer>\n",
                    escape_html(study.text("program_version")), study.whole("study_id"));
    page += "<script type=\"application/json\" id=\"study-data\">" + page_data(tables) + "</script>\n";
    return page + scripts() + "</body>\n</html>\n";
}

}  // namespace capstan::reports
