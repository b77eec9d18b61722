#pragma once
// A figure's place on the page: title, room for the chart, caption, data. page.js draws the chart into it.

#include <cstdint>
#include <string>

#include "capstan/reports/figure_catalogue.h"
#include "capstan/reports/table.h"

namespace capstan::reports {

// Which rows a figure shows; the noise level is the reader's choice on the page.
struct FigureRows {
    std::string regime;                  // '': all
    std::int64_t recommendation_id = 0;  // 0: all
    std::int64_t run = 0;                // of a recording, 0: all
    std::string cable{};                 // '': all
    std::string name{};                  // of a recommendation, for the figure's own name
};

// '' when a table has no such rows: a figure without data is left out.
std::string figure_html(const Tables& tables, const Figure& figure, const FigureRows& rows);

}  // namespace capstan::reports
