#include "capstan/logs/text_layout.h"

#include <fmt/format.h>

#include <algorithm>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/table_writer.h"
#include "capstan/logs/text_lines.h"

namespace capstan::logs {

namespace {

using Cells = std::vector<std::string_view>;

bool has_prefix(std::string_view line, const std::vector<std::string>& prefixes) {
    line = trimmed(line);
    return std::any_of(prefixes.begin(), prefixes.end(),
                       [&](const std::string& prefix) { return line.starts_with(prefix); });
}

// "Time [s]" separated by blanks are two cells that belong together.
Cells with_units_joined(const Cells& cells) {
    Cells joined;
    bool open = false;
    for (const std::string_view cell : cells) {
        const bool opens = !cell.empty() && (cell.front() == '[' || cell.front() == '(');
        if ((open || opens) && !joined.empty())
            joined.back() = {joined.back().data(),
                             static_cast<std::size_t>(cell.data() + cell.size() - joined.back().data())};
        else
            joined.push_back(cell);
        const bool closes = !cell.empty() && (cell.back() == ']' || cell.back() == ')');
        if (opens || closes) open = opens && !closes;
    }
    return joined;
}

// A line of the head as `fields` cells; empty where it is none.
Cells head_cells(std::string_view line, const CellStyle& style, std::size_t fields, bool any_delimiter) {
    Cells cells;
    split_cells(line, style.delimiter, cells);
    if (cells.size() == fields + 1 && cells.back().empty()) cells.pop_back();
    if (cells.size() == fields) return cells;
    if (style.delimiter == ' ' && with_units_joined(cells).size() == fields) return with_units_joined(cells);
    for (const char other : {',', '\t', ';', ' '}) {
        if (!any_delimiter || fields < 2) break;
        split_cells(line, other, cells);
        if (cells.size() == fields) return cells;
        if (other == ' ' && with_units_joined(cells).size() == fields) return with_units_joined(cells);
    }
    return {};
}

bool is_all_units(const Cells& cells) {
    std::size_t units = 0, others = 0;
    for (const std::string_view cell : cells) {
        if (cell.empty() || cell == "-" || cell == "[]" || cell == "[-]") continue;
        ++(is_unit(cell) ? units : others);
    }
    return units > others;
}

class LayoutSearch {
  public:
    LayoutSearch(const std::vector<std::string>& lines, const TextFormat& stated, std::string file)
        : lines_(lines), stated_(stated), file_(std::move(file)) {
        layout_.comments = stated.comments ? std::vector<std::string>{*stated.comments}
                                           : std::vector<std::string>{"#", "%", "//", ";"};
        if (stated.delimiter == ';' && !stated.comments) layout_.comments.pop_back();
    }

    TextLayout find() {
        find_style();
        find_kinds();
        find_first_data_line();
        find_head();
        name_columns();
        return layout_;
    }

  private:
    bool is_empty(std::size_t line) const { return trimmed(lines_[line]).empty(); }

    std::string_view without_prefix(std::string_view line) const {
        line = trimmed(line);
        for (const std::string& prefix : layout_.comments)
            while (!prefix.empty() && line.starts_with(prefix)) line.remove_prefix(prefix.size());
        return trimmed(line);
    }

    void find_style() {
        std::vector<std::string_view> content;
        for (std::size_t line = static_cast<std::size_t>(stated_.head_line.value_or(0)); line < lines_.size();
             ++line)
            if (!is_empty(line) && !layout_.is_comment(lines_[line])) content.push_back(lines_[line]);
        // The head and what stands before it are at the beginning; data fill the rest.
        content.erase(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(content.size() / 2));
        const StyleTrial best = content.empty() ? StyleTrial() : best_style(content, stated_);
        if (best.score() <= 0.0)
            throw InvalidInput(
                {fmt::format("{}: no line of numbers was found among the first {}; the first line is '{}'",
                             file_, lines_.size(), as_utf8(std::string_view(lines_.front()).substr(0, 60)))});
        layout_.style = best.style;
        fields_ = best.fields;
        if (fields_ > LogLimits::columns)
            throw InvalidInput({fmt::format("{}: has more than {} columns", file_, LogLimits::columns)});
        if (layout_.style.delimiter == ';' && !stated_.comments) std::erase(layout_.comments, ";");
        data_sample_ = std::move(content);
    }

    void find_kinds() {
        std::vector<std::array<std::size_t, 3>> seen(fields_);  // numbers, instants, text
        last_is_empty_ = true;
        Cells cells;
        for (const std::string_view line : data_sample_) {
            split_cells(line, layout_.style.delimiter, cells);
            if (cells.size() != fields_) continue;
            last_is_empty_ = last_is_empty_ && cells.back().empty();
            for (std::size_t column = 0; column < fields_; ++column) {
                bool is_missing = false;
                const ColumnKind kind = kind_of(cells[column], layout_.style, is_missing);
                if (!is_missing) ++seen[column][static_cast<std::size_t>(kind)];
            }
        }
        layout_.columns.resize(fields_);
        for (std::size_t column = 0; column < fields_; ++column) {
            const auto& [numbers, instants, text] = seen[column];
            layout_.columns[column].kind = instants > numbers && instants >= text ? ColumnKind::instants
                                           : text > numbers                       ? ColumnKind::text
                                                                                  : ColumnKind::numbers;
        }
    }

    bool is_data(std::string_view line) const {
        Cells cells;
        split_cells(line, layout_.style.delimiter, cells);
        if (cells.size() != fields_) return false;
        for (std::size_t column = 0; column < fields_; ++column) {
            bool is_missing = false;
            const ColumnKind kind = kind_of(cells[column], layout_.style, is_missing);
            if (kind == ColumnKind::text && layout_.columns[column].kind != ColumnKind::text) return false;
        }
        return true;
    }

    void find_first_data_line() {
        for (std::size_t line = static_cast<std::size_t>(stated_.head_line.value_or(0)); line < lines_.size();
             ++line)
            if (!is_empty(line) && !layout_.is_comment(lines_[line]) && is_data(lines_[line])) {
                layout_.first_data_line = line + 1;
                return;
            }
        throw InvalidInput(
            {fmt::format("{}: no line of numbers was found among the first {}", file_, lines_.size())});
    }

    void find_head() {
        if (stated_.head_line) {
            layout_.head_line = *stated_.head_line;
            if (layout_.head_line == 0) return drop_empty_last();
            const std::string_view line = lines_[static_cast<std::size_t>(layout_.head_line - 1)];
            const std::string_view bare = layout_.is_comment(line) ? without_prefix(line) : line;
            head_ = head_cells(bare, layout_.style, fields_, true);
            if (head_.empty() && last_is_empty_ && fields_ > 1) {
                head_ = head_cells(bare, layout_.style, fields_ - 1, true);
                if (!head_.empty()) drop_empty_last();
            }
            if (head_.empty())
                throw InvalidInput(
                    {fmt::format("{}: line {} is to be the head, but has not {} fields as the data have",
                                 file_, layout_.head_line, fields_)});
            find_units_after_head();
        } else {
            find_head_with(fields_);
            if (last_is_empty_ && fields_ > 1) {
                if (head_.empty()) find_head_with(fields_ - 1);
                if (head_.size() != fields_ || head_.back().empty()) drop_empty_last();
            }
        }
        for (std::size_t line = 0; line + 1 < layout_.first_data_line; ++line)
            if (!is_empty(line) && !layout_.is_comment(lines_[line]) &&
                static_cast<int>(line) + 1 != layout_.head_line && line != units_line_)
                ++layout_.lines_left_out;
    }

    void drop_empty_last() {
        if (!last_is_empty_ || fields_ < 2) return;
        layout_.columns.resize(--fields_);
        if (head_.size() > fields_) head_.resize(fields_);
    }

    void find_units_after_head() {
        for (auto line = static_cast<std::size_t>(layout_.head_line); line + 1 < layout_.first_data_line;
             ++line) {
            const Cells cells = head_cells(without_prefix(lines_[line]), layout_.style, fields_, false);
            if (!cells.empty() && is_all_units(cells)) units_ = cells, units_line_ = line;
        }
    }

    // The line before the data may name a further column that has only empty cells, which the data leave out.
    bool find_wider_head() {
        const std::size_t line = layout_.first_data_line - 2;
        if (layout_.first_data_line < 2 || is_empty(line) || layout_.is_comment(lines_[line])) return false;
        Cells cells;
        split_cells(lines_[line], layout_.style.delimiter, cells);
        bool is_missing = false;
        if (layout_.style.delimiter == ' ' || cells.size() != fields_ + 1 || cells.back().empty() ||
            std::any_of(cells.begin(), cells.end(), [&](std::string_view cell) {
                return kind_of(cell, layout_.style, is_missing) != ColumnKind::text;
            }))
            return false;
        cells.pop_back();
        head_ = cells;
        layout_.head_line = static_cast<int>(line) + 1;
        return true;
    }

    // Lines of text first, comments where there is none.
    void find_head_with(std::size_t fields) {
        if (find_wider_head()) return;
        for (const bool of_comments : {false, true}) {
            std::vector<std::size_t> candidates;
            for (std::size_t line = 0; line + 1 < layout_.first_data_line; ++line) {
                if (is_empty(line) || layout_.is_comment(lines_[line]) != of_comments) continue;
                const std::string_view bare =
                    of_comments ? without_prefix(lines_[line]) : std::string_view(lines_[line]);
                const bool is_next_to_data = line + 2 == layout_.first_data_line;
                const Cells cells = head_cells(bare, layout_.style, fields, of_comments || is_next_to_data);
                const bool is_prose = fields == 1 && of_comments && (!is_next_to_data || bare.size() > 40);
                if (!cells.empty() && !is_prose && !(of_comments && is_data(bare)))
                    candidates.push_back(line);
            }
            if (candidates.empty()) continue;
            const auto cells_at = [&](std::size_t line) {
                return head_cells(of_comments ? without_prefix(lines_[line]) : std::string_view(lines_[line]),
                                  layout_.style, fields, true);
            };
            std::size_t line = candidates.back();
            if (candidates.size() > 1 && is_all_units(cells_at(line))) {
                units_ = cells_at(line);
                units_line_ = line;
                line = candidates[candidates.size() - 2];
            }
            head_ = cells_at(line);
            layout_.head_line = static_cast<int>(line) + 1;
            return;
        }
    }

    void name_columns() {
        UniqueNames unique;
        for (std::size_t column = 0; column < fields_; ++column) {
            TextColumn& own = layout_.columns[column];
            NameAndUnit head;
            if (!head_.empty()) head = name_and_unit(head_[column]);
            if (!units_.empty() && head.unit.empty()) {
                head.unit = without_brackets(units_[column]);
                if (head.unit == "-") head.unit.clear();
            }
            if (head.name.empty()) head.name = fmt::format("column_{}", column + 1);
            own.name = unique(as_utf8(head.name));
            own.unit = as_utf8(head.unit);
        }
    }

    const std::vector<std::string>& lines_;
    const TextFormat& stated_;
    std::string file_;
    TextLayout layout_;
    std::size_t fields_ = 0;
    bool last_is_empty_ = false;
    std::vector<std::string_view> data_sample_;
    Cells head_;
    Cells units_;
    std::size_t units_line_ = SIZE_MAX;
};

}  // namespace

bool TextLayout::is_comment(std::string_view line) const {
    return has_prefix(line, comments);
}

TextLayout find_layout(const std::vector<std::string>& lines, const TextFormat& stated,
                       const std::string& file) {
    if (stated.head_line &&
        (*stated.head_line < 0 || static_cast<std::size_t>(*stated.head_line) >= lines.size()))
        throw InvalidInput(
            {fmt::format("{}: line {} is to be the head, but no line of data follows it among the first {}",
                         file, *stated.head_line, lines.size())});
    return LayoutSearch(lines, stated, file).find();
}

}  // namespace capstan::logs
