#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "capstan/logs/table_writer.h"
#include "capstan/logs/text_layout.h"

namespace capstan::logs {

/// Something that happens on many lines and is told once.
struct LineTally {
    std::size_t count = 0;
    std::size_t first = 0;

    void add(std::size_t line) {
        if (count++ == 0) first = line;
    }
};

/// Makes a table of lines of text, the layout of which is known.
class TextTable {
  public:
    TextTable(const TextLayout& layout, TableWriter& writer, const std::string& name);

    /// `number`: of the line in its file, from 1; `is_unfinished`: it has no line end.
    void take(std::string_view line, std::size_t number, bool is_unfinished = false);
    /// Remarks on what was left out.
    void end();

  private:
    /// The instants of a column: where its seconds begin, and how its dates are read.
    struct Instants {
        std::optional<CellInstant> origin{};
        std::string origin_text{};
        std::optional<DateOrder> order{};  ///< settled by a later row
        std::string_view settled_by{};
    };

    bool fill_row(std::size_t number);
    CellKind instant(std::string_view cell, Instants& column, double& seconds);
    static void settle_order(std::string_view cell, const CellInstant& now, Instants& column);
    static std::string words_on_dates(const Instants& column);

    const TextLayout& layout_;
    TableWriter& writer_;
    int table_;
    std::vector<int> slots_;  ///< columns of the file: index in the table, or -1
    std::vector<std::string_view> cells_;
    std::vector<std::size_t> bad_columns_;
    std::vector<LineTally> not_numbers_;  ///< columns of the file
    std::vector<Instants> instants_;
    LineTally too_few_, too_many_, no_data_;
    std::size_t ends_without_line_end_ = 0;
};

}  // namespace capstan::logs
