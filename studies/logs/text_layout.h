#pragma once

#include <string>
#include <vector>

#include "capstan/logs/text_cells.h"
#include "capstan/logs/text_format.h"

namespace capstan::logs {

enum class ColumnKind { numbers, instants, text };

struct TextColumn {
    std::string name;
    std::string unit;
    ColumnKind kind = ColumnKind::numbers;
};

/// How a text file is written, found from its first lines.
struct TextLayout {
    CellStyle style;
    std::vector<std::string> comments;  ///< what a line to be left out begins with
    int head_line = 0;                  ///< from 1; 0: there is none
    std::size_t first_data_line = 0;    ///< from 1
    std::size_t lines_left_out = 0;     ///< before the data, neither comments nor the head nor its units
    std::vector<TextColumn> columns;

    bool is_comment(std::string_view line) const;
};

/// What a cell would be in a column of its own; `is_missing`: nothing.
ColumnKind kind_of(std::string_view cell, const CellStyle& style, bool& is_missing);

/// A style, and how well it suits some lines.
struct StyleTrial {
    CellStyle style;
    std::size_t fields = 0;
    double regular = 0.0;  ///< fraction of the lines with as many fields
    double numeric = 0.0;  ///< fraction of their cells with a number or an instant, or empty
    double score() const { return regular * numeric; }
};

/// The style that suits lines of data best; what `stated` has is not tried otherwise.
StyleTrial best_style(const std::vector<std::string_view>& lines, const TextFormat& stated);

/// `lines`: the first of the file, at least one of them with numbers. What `stated` has is not guessed.
/// Throws InvalidInput with `file` in front.
TextLayout find_layout(const std::vector<std::string>& lines, const TextFormat& stated,
                       const std::string& file);

}  // namespace capstan::logs
