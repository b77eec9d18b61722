// The page of an answer.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "capstan/reports/answer.h"
#include "capstan/reports/figure_html.h"
#include "capstan/reports/html_text.h"
#include "capstan/reports/page_data.h"
#include "capstan/reports/page_frame.h"

namespace capstan::reports {
namespace {

// The class of each column: words are read from the left, numbers compared from the right.
std::vector<std::string> column_classes(const std::vector<std::vector<std::string>>& cells) {
    std::vector<std::string> classes;
    for (std::size_t k = 0; k < cells[0].size(); ++k) {
        const bool has_words = std::any_of(cells.begin() + 1, cells.end(), [k](const auto& row) {
            return !row[k].empty() && std::isalpha(static_cast<unsigned char>(row[k][0])) != 0;
        });
        classes.emplace_back(has_words ? "words" : "number");
    }
    return classes;
}

std::string table_html(const AnswerTable& table) {
    const auto cells = cells_of(table);
    const std::vector<std::string> classes = column_classes(cells);
    std::string heads;
    std::string rows;
    for (std::size_t row = 0; row < cells.size(); ++row) {
        if (row > 0) rows += "<tr>";
        for (std::size_t k = 0; k < cells[row].size(); ++k) {
            const std::string of_class = k == 0 ? "" : fmt::format(" class=\"{}\"", classes[k]);
            const std::string cell = escape_html(cells[row][k]);
            if (row == 0)
                heads += fmt::format("<th scope=\"col\"{}>{}</th>", of_class, cell);
            else
                rows += k == 0 ? fmt::format("<th scope=\"row\">{}</th>", cell)
                               : fmt::format("<td{}>{}</td>", of_class, cell);
        }
        if (row > 0) rows += "</tr>\n";
    }
    return fmt::format(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\"><table class=\"numbers\"><caption>{0}</caption>"
        "<thead><tr>{1}</tr></thead><tbody>\n{2}</tbody></table></div>\n",
        escape_html(table.caption), heads, rows);
}

std::string figures_html(const Tables& tables, const std::string& page, const std::string& section) {
    std::string html;
    for (const Figure& figure : figures()) {
        if (figure.page != page || figure.section != section) continue;
        if (figure.per != "run" && figure.per != "run and cable") {
            html += figure_html(tables, figure, {});
            continue;
        }
        const bool by_cable = figure.per == "run and cable";
        for (const Row& run : tables["run"].each()) {
            for (const char* cable : {"A", "B"}) {
                FigureRows rows{.regime = {}, .run = run.integer("run")};
                if (by_cable) rows.cable = cable;
                html += figure_html(tables, figure, rows);
                if (!by_cable) break;
            }
        }
    }
    return html;
}

std::string making_html(const Answer& answer) {
    std::string html;
    if (!answer.config_text.empty()) {
        html +=
            "<details class=\"config\"><summary>Configuration, every key written out</summary><pre "
            "tabindex=\"0\">" +
            escape_html(answer.config_text) + "</pre></details>\n";
    }
    return html +
           "<h3>All tables</h3>\n<p>Six significant digits, as drawn.</p>\n<ul id=\"downloads\"></ul>\n";
}

std::string answer_page(const Answer& answer, PageFiles files) {
    const Tables drawn(answer.drawn);
    PageFrame frame;
    std::vector<SectionLink> links;
    for (const AnswerSection& section : answer.sections) {
        const std::string heading = section.heading.empty() ? "The numbers" : section.heading;
        std::string content;
        for (const AnswerTable& table : section.tables) content += table_html(table);
        content += figures_html(drawn, answer.id, section.id);
        if (!section.note.empty()) content += "<p class=\"intro\">" + escape_html(section.note) + "</p>\n";
        if (section.heading.empty() && content.empty()) {  // words alone
            if (!section.prose.empty()) frame.main_html += "<p>" + escape_html(section.prose) + "</p>\n";
            continue;
        }
        frame.main_html += section_html(section.id, heading, section.prose, content);
        links.push_back({section.id, heading});
    }
    frame.main_html +=
        section_html("making", "The data", "What the figures draw, to save as CSV.", making_html(answer));
    links.push_back({"making", "The data"});
    frame.document_title = answer.title + " – capstan";
    frame.kind = answer.kind;
    frame.title = answer.title;
    frame.verdict = answer.headline;
    frame.navigation_html = navigation_html(frame.main_html, links, "");
    frame.footer = "Made by capstan " + program_version() + ".";
    frame.data_json = page_data(drawn, answer.id);
    return page_html(frame, files);
}

}  // namespace

std::string answer_html(const Answer& answer) {
    return answer_page(answer, PageFiles::inside);
}

std::string answer_live_html(const Answer& answer) {
    return answer_page(answer, PageFiles::served);
}

}  // namespace capstan::reports
