#include "capstan/reports/figure_html.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "capstan/reports/html_text.h"

namespace capstan::reports {
namespace {

bool is_shown(const Table& table, const Row& row, const Figure& figure, const FigureRows& shown) {
    if (!shown.regime.empty() && table.has_column("regime") && row.text("regime") != shown.regime)
        return false;
    if (shown.recommendation_id != 0 && table.has_column("recommendation_id") &&
        row.integer("recommendation_id") != shown.recommendation_id) {
        return false;
    }
    if (shown.run != 0 && table.has_column("run") && row.integer("run") != shown.run) return false;
    if (!shown.cable.empty() && table.has_column("cable") && row.text("cable") != shown.cable) return false;
    if (figure.knowledge.empty() || !table.has_column("knowledge")) return true;
    return std::find(figure.knowledge.begin(), figure.knowledge.end(), row.text("knowledge")) !=
           figure.knowledge.end();
}

bool has_rows(const Table& table, const Figure& figure, const FigureRows& shown) {
    const auto rows = table.each();
    return std::any_of(rows.begin(), rows.end(),
                       [&](const Row& row) { return is_shown(table, row, figure, shown); });
}

// The chart's height is known before it is drawn, so nothing on the page moves.
int chart_height_px(const Table& table, const Figure& figure, const FigureRows& shown) {
    std::size_t panel_rows = 1;
    if (!figure.rows_by.empty()) {
        std::set<std::string> values;
        for (const Row& row : table.each()) {
            if (is_shown(table, row, figure, shown)) values.insert(row.text(figure.rows_by));
        }
        panel_rows = std::max<std::size_t>(1, values.size());
    }
    constexpr int legend_row_px = 16;  // a legend may need one more row on a narrow screen
    return figure.frame_height_px + legend_row_px +
           static_cast<int>(panel_rows) * (figure.panel_height_px + figure.row_frame_height_px);
}

}  // namespace

std::string figure_html(const Tables& tables, const Figure& figure, const FigureRows& rows) {
    for (const std::string& table : figure.tables) {
        if (!has_rows(tables[table], figure, rows)) return "";
    }
    std::string id = "figure-" + figure.id;
    std::string title = figure.title;
    if (!rows.regime.empty()) {
        id += fmt::format("-{}", rows.regime);
        title = fmt::format("{}: {}", regime_title(rows.regime), figure.title);
    }
    if (!rows.name.empty()) id += "-" + rows.name;
    if (rows.run != 0) {
        id += fmt::format("-{}", rows.run);
        title = fmt::format("Run {}: {}", rows.run, figure.title);
    }
    if (!rows.cable.empty()) {
        id += fmt::format("-{}", rows.cable);
        title = fmt::format("Run {}, cable {}: {}", rows.run, rows.cable, figure.title);
    }
    const auto original = figure.paper.find(rows.regime);
    const std::string paper =
        original == figure.paper.end()
            ? ""
            : fmt::format(R"( <span class="paper-figure">paper: {}</span>)", escape_html(original->second));
    return fmt::format(
        R"(<figure id="{id}" data-figure="{figure}" data-regime="{regime}" data-recommendation="{recommendation}" data-run="{run}" data-cable="{cable}">
<h3 id="{id}-title">{title}{paper}</h3>
<div class="chart" role="group" aria-labelledby="{id}-title" aria-describedby="{id}-caption" style="min-height:{height}px"></div>
<figcaption id="{id}-caption">{caption}</figcaption>
<details class="data"><summary>Data</summary><div class="data-rows"></div></details>
</figure>
)",
        fmt::arg("id", escape_html(id)), fmt::arg("figure", escape_html(figure.id)),
        fmt::arg("regime", escape_html(rows.regime)),
        fmt::arg("recommendation", rows.recommendation_id == 0 ? "" : std::to_string(rows.recommendation_id)),
        fmt::arg("cable", escape_html(rows.cable)),
        fmt::arg("run", rows.run == 0 ? "" : std::to_string(rows.run)), fmt::arg("title", escape_html(title)),
        fmt::arg("paper", paper),
        fmt::arg("height", chart_height_px(tables[figure.tables.front()], figure, rows)),
        fmt::arg("caption", escape_html(figure.caption)));
}

}  // namespace capstan::reports
