// Which delimiter a text file has, and whether its decimals are commas.
#include <array>
#include <map>

#include "capstan/logs/text_layout.h"

namespace capstan::logs {

namespace {

// A tie of two styles is decided for the earlier one.
constexpr std::array<CellStyle, 9> cell_styles{{{'\t', false},
                                                {'\t', true},
                                                {';', false},
                                                {';', true},
                                                {'|', false},
                                                {'|', true},
                                                {',', false},
                                                {' ', false},
                                                {' ', true}}};

StyleTrial tried(const CellStyle& style, const std::vector<std::string_view>& lines) {
    std::map<std::size_t, std::size_t> lines_with;
    std::vector<std::string_view> cells;
    for (const std::string_view line : lines) {
        split_cells(line, style.delimiter, cells);
        ++lines_with[cells.size()];
    }
    StyleTrial trial{style};
    std::size_t modal = 0;
    for (const auto& [fields, count] : lines_with)
        if (fields > 0 && count >= modal) trial.fields = fields, modal = count;
    std::size_t numeric = 0, numbers = 0;
    for (const std::string_view line : lines) {
        split_cells(line, style.delimiter, cells);
        if (cells.size() != trial.fields) continue;
        for (const std::string_view cell : cells) {
            bool is_missing = false;
            if (kind_of(cell, style, is_missing) == ColumnKind::text) continue;
            ++numeric;
            numbers += is_missing ? 0 : 1;
        }
    }
    if (numbers == 0) return trial;
    trial.regular = static_cast<double>(modal) / static_cast<double>(lines.size());
    trial.numeric = static_cast<double>(numeric) / static_cast<double>(modal * trial.fields);
    return trial;
}

}  // namespace

ColumnKind kind_of(std::string_view cell, const CellStyle& style, bool& is_missing) {
    double number = 0.0;
    const CellKind kind = number_of_cell(cell, style.decimal_comma, number);
    is_missing = kind == CellKind::missing;
    if (kind != CellKind::text) return ColumnKind::numbers;
    return instant_of_cell(cell) ? ColumnKind::instants : ColumnKind::text;
}

StyleTrial best_style(const std::vector<std::string_view>& lines, const TextFormat& stated) {
    StyleTrial best;
    bool has_strong = false;
    for (CellStyle style : cell_styles) {
        if (stated.delimiter && style.delimiter != (style.delimiter == ' ' ? ' ' : '\t')) continue;
        if (stated.delimiter) style.delimiter = *stated.delimiter;
        if (stated.decimal_comma && style.decimal_comma != *stated.decimal_comma) {
            if (style.delimiter != ',') continue;
            style.decimal_comma = *stated.decimal_comma;
        }
        const StyleTrial trial = tried(style, lines);
        // "1,5" alone is rather two columns than one number.
        if (style.decimal_comma && trial.fields < 2 && !stated.decimal_comma) continue;
        const bool is_weak = style.delimiter == ' ' || style.delimiter == ',';
        has_strong =
            has_strong || (!is_weak && trial.fields > 1 && trial.regular > 0.9 && trial.score() > 0.0);
        // Blanks and commas inside the cells of a table with tabs or semicolons separate nothing.
        if (is_weak && has_strong && trial.score() < 0.999) continue;
        const double gain = trial.score() - best.score();
        if (gain > 1e-9 || (gain > -1e-9 && trial.score() > 0.0 && trial.fields > best.fields)) best = trial;
    }
    return best;
}

}  // namespace capstan::logs
