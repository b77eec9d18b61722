#include "capstan/reports/recommendation_section.h"

#include <fmt/format.h>

#include <cctype>

#include "capstan/reports/cable_drawing.h"
#include "capstan/reports/figure_html.h"
#include "capstan/reports/html_text.h"
#include "capstan/storage/records.h"

namespace capstan::reports {
namespace {

std::vector<int> node_list(const Row& row) {
    return storage::parse_node_list(row.text("nodes"));
}

std::string nodes_in_words(const Row& row, const std::vector<double>& positions_m) {
    std::string numbers, places;
    for (const int node : node_list(row)) {
        numbers += (numbers.empty() ? "" : ", ") + std::to_string(node);
        const std::size_t index = static_cast<std::size_t>(node) - 1;
        if (index < positions_m.size())
            places += fmt::format("{}{:.3g}", places.empty() ? "" : ", ", positions_m[index]);
    }
    return places.empty() ? numbers : fmt::format("{} <small>({} m from the motor)</small>", numbers, places);
}

std::string alternatives(const StudyTables& tables, std::int64_t recommendation_id) {
    std::string rows;
    int count = 0;
    for (const Row& row : tables["recommendation_alternative"].each()) {
        if (row.integer("recommendation_id") != recommendation_id) continue;
        ++count;
        rows += fmt::format(
            "<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"number\">{}</td><td "
            "class=\"number\">{}</td></tr>\n",
            escape_html(row.text("layout")), escape_html(row.text("nodes")),
            escape_html(row.text("method_title")), plain_number(row.number("difference_N")),
            newtons_between(row.number("interval_low_N"), row.number("interval_high_N")));
    }
    if (count == 0)
        return "<p class=\"quiet\">All other compared choices with this many sensors are significantly worse.</p>\n";
    return fmt::format(
        R"(<details class="alternatives"><summary>{} other {} not significantly worse</summary>
<div class="scroll" tabindex="0" role="region" aria-label="Choices that are not significantly worse than the recommended one"><table><thead><tr><th scope="col">Layout</th><th scope="col">Nodes</th><th scope="col">Fusion method</th><th scope="col">Difference [N]</th><th scope="col">95% interval</th></tr></thead><tbody>
{}</tbody></table></div></details>
)",
        count, count == 1 ? "choice" : "choices", rows);
}

const Figure* chart_of_counts() {
    for (const Figure& figure : figures()) {
        if (figure.per == "recommendation") return &figure;
    }
    return nullptr;
}

// "duty_cycle-5-percent", for names of files: letters, digits and hyphens.
std::string short_name(const Row& recommendation) {
    const std::string scope = recommendation.text("scope");
    std::string name = scope == "regime" ? recommendation.text("regime") : scope;
    bool joins = true;
    for (const char letter : recommendation.text("noise")) {
        const bool is_plain = std::isalnum(static_cast<unsigned char>(letter)) != 0;
        if (is_plain || letter == '%') {
            name += joins ? "-" : "";
            name += is_plain ? std::string(1, letter) : "percent";
        }
        joins = !is_plain;
    }
    return name;
}

std::string card(const StudyTables& tables, const Row& row, const std::vector<double>& positions_m) {
    const std::int64_t id = row.integer("recommendation_id");
    const Figure* chart = chart_of_counts();
    return fmt::format(
        R"(<article class="advice" data-noise="{noise_id}" aria-labelledby="advice-{id}">
<div class="advice-text">
<h3 id="advice-{id}">{title}</h3>
<p class="noise-of">with sensor noise {noise}</p>
<p class="sentence">{sentence}</p>
{cable}<dl>
<div class="headline"><dt>{objective}</dt><dd>{error} <small>95% interval {interval}</small></dd></div>
<div><dt>Sensors</dt><dd>{count}</dd></div>
<div><dt>Fusion method</dt><dd>{method}</dd></div>
<div class="wide"><dt>Nodes</dt><dd>{nodes}</dd></div>
</dl>
{alternatives}</div>
<div class="advice-chart">{chart}</div>
</article>
)",
        fmt::arg("noise_id", row.integer("noise_level_id")), fmt::arg("id", id),
        fmt::arg("title", escape_html(recommendation_title(row))),
        fmt::arg("noise", escape_html(row.text("noise"))),
        fmt::arg("sentence", escape_html(row.text("sentence"))),
        fmt::arg("cable", cable_drawing(tables["cable_segment"], node_list(row))),
        fmt::arg("objective", escape_html(objective_title(row))),
        fmt::arg("error", newtons(row.number("error_N"))),
        fmt::arg("interval", newtons_between(row.number("interval_low_N"), row.number("interval_high_N"))),
        fmt::arg("count", row.integer("sensor_count")),
        fmt::arg("method", escape_html(row.text("method_title"))),
        fmt::arg("nodes", nodes_in_words(row, positions_m)),
        fmt::arg("alternatives", alternatives(tables, id)),
        fmt::arg("chart",
                 chart == nullptr
                     ? ""
                     : figure_html(tables, *chart,
                                   {.regime = "", .recommendation_id = id, .name = short_name(row)})));
}

}  // namespace

std::string recommendation_title(const Row& recommendation) {
    const std::string scope = recommendation.text("scope");
    if (scope == "minimax_regret") return "Across regimes: smallest worst regret";
    if (scope == "duty_cycle") return "Across regimes: smallest error over the duty cycle";
    return regime_title(recommendation.text("regime"));
}

std::string objective_title(const Row& recommendation) {
    const std::string scope = recommendation.text("scope");
    if (scope == "minimax_regret") return "Largest regret: error above the regime's own best";
    if (scope == "duty_cycle") return "Mean tension error, weighted by working time";
    return "Mean tension error";
}

std::string verdict(const StudyTables& tables) {
    const auto rows = tables["recommendation"].each();
    for (const char* scope : {"duty_cycle", "minimax_regret", "regime"}) {
        for (const Row& row : rows) {
            if (row.text("scope") == scope) return row.text("sentence");
        }
    }
    return tables.study().text("status") == "complete"
               ? "This study measured errors only; it holds no recommendation."
               : "This study is still running: the figures show what is done, and there is no recommendation "
                 "yet.";
}

std::string recommendation_section(const StudyTables& tables) {
    const auto rows = tables["recommendation"].each();
    if (rows.empty()) return "";
    const std::vector<double> positions_m = node_positions_m(tables["cable_segment"]);
    std::string html =
        "<section id=\"recommendation\" aria-labelledby=\"recommendation-title\">\n"
        "<h2 id=\"recommendation-title\">Recommendations</h2>\n"
        "<p class=\"intro\">Sensors are pinned on the cable at their nodes; darker bands bend more sharply. "
        "The chart beside "
        "each cable shows what every further sensor would buy.</p>\n";
    for (const Row& row : rows) html += card(tables, row, positions_m);
    return html + "</section>\n";
}

}  // namespace capstan::reports
