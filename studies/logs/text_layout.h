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

/// `lines`: the first of the file, at least one of them with numbers. What `stated` has is not guessed.
/// Throws InvalidInput with `file` in front.
TextLayout find_layout(const std::vector<std::string>& lines, const TextFormat& stated,
                       const std::string& file);

}  // namespace capstan::logs
