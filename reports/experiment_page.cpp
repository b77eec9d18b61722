#include "capstan/reports/experiment_page.h"

#include <fmt/format.h>

#include "capstan/reports/figure_html.h"
#include "capstan/reports/html_text.h"
#include "capstan/reports/page_data.h"
#include "capstan/reports/page_frame.h"

namespace capstan::reports {
namespace {

std::string row_html(const std::vector<std::string>& cells) {
    std::string html = "<tr>";
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const std::string cell = escape_html(cells[k]);
        html += k == 0 ? "<th scope=\"row\">" + cell + "</th>" : "<td class=\"number\">" + cell + "</td>";
    }
    return html + "</tr>\n";
}

std::string numbers_html(const NumberTable& numbers) {
    std::string heads;
    for (std::size_t k = 0; k < numbers.heads.size(); ++k)
        heads += fmt::format("<th scope=\"col\"{}>{}</th>", k == 0 ? "" : " class=\"number\"",
                             escape_html(numbers.heads[k]));
    std::string rows;
    for (const auto& row : numbers.rows) rows += row_html(row);
    return fmt::format(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\"><table class=\"numbers\"><caption>{0}</caption>"
        "<thead><tr>{1}</tr></thead><tbody>\n{2}</tbody></table></div>\n",
        escape_html(numbers.caption), heads, rows);
}

std::string figures_html(const Tables& tables, const std::string& page, const std::string& section) {
    std::string html;
    for (const Figure& figure : figures()) {
        if (figure.page != page || figure.section != section) continue;
        if (figure.per != "run") {
            html += figure_html(tables, figure, {});
            continue;
        }
        for (const Row& run : tables["run"].each())
            html += figure_html(tables, figure, {.regime = {}, .run = run.integer("run")});
    }
    return html;
}

std::string making_html(const ExperimentPage& page) {
    std::string html;
    if (!page.config_text.empty()) {
        html +=
            "<details class=\"config\"><summary>Configuration, every key written out</summary><pre "
            "tabindex=\"0\">" +
            escape_html(page.config_text) + "</pre></details>\n";
    }
    return html +
           "<h3>All tables</h3>\n<p>Six significant digits, as drawn.</p>\n<ul id=\"downloads\"></ul>\n";
}

}  // namespace

std::string experiment_page_html(const ExperimentPage& page) {
    const Tables tables(page.tables);
    PageFrame frame;
    std::vector<SectionLink> links;
    for (const ExperimentSection& section : page.sections) {
        std::string content;
        for (const NumberTable& numbers : section.numbers) content += numbers_html(numbers);
        content += figures_html(tables, page.id, section.id);
        if (!section.closing.empty())
            content += "<p class=\"intro\">" + escape_html(section.closing) + "</p>\n";
        frame.main_html += section_html(section.id, section.title, section.intro, content);
        links.push_back({section.id, section.title});
    }
    frame.main_html +=
        section_html("making", "The data", "What the figures draw, to save as CSV.", making_html(page));
    links.push_back({"making", "The data"});
    frame.document_title = page.title + " – capstan";
    frame.kind = page.kind;
    frame.title = page.title;
    frame.verdict = page.verdict;
    frame.navigation_html = navigation_html(frame.main_html, links, "");
    frame.footer = "Made by capstan " + page.program_version + ".";
    frame.data_json = page_data(tables, page.id);
    return page_html(frame);
}

std::size_t drawn_every(std::size_t samples, std::size_t limit) {
    return samples <= limit ? 1 : (samples + limit - 1) / limit;
}

}  // namespace capstan::reports
