#include "capstan/logs/text_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <limits>

namespace capstan::logs {

namespace {

std::string words_of(const LineTally& tally, std::string_view one, std::string_view several) {
    return tally.count == 1
               ? fmt::format("Line {}: {}", tally.first, one)
               : fmt::format("{} lines, the first is line {}: {}", tally.count, tally.first, several);
}

std::string count_of_lines(std::size_t count) {
    return count == 1 ? "A line" : fmt::format("{} lines", count);
}

}  // namespace

TextTable::TextTable(const TextLayout& layout, TableWriter& writer, const std::string& name)
    : layout_(layout), writer_(writer), table_(writer.add_table(name)), slots_(layout.columns.size(), -1) {
    std::vector<std::string> left_out;
    for (std::size_t column = 0; column < layout.columns.size(); ++column) {
        const TextColumn& own = layout.columns[column];
        if (own.kind == ColumnKind::text)
            left_out.push_back(own.name);
        else
            slots_[column] =
                writer_.add_column(table_, own.name, own.kind == ColumnKind::instants ? "s" : own.unit);
    }
    if (!left_out.empty())
        writer_.remark(fmt::format("{} of text {} left out: {}",
                                   left_out.size() == 1 ? "A column" : "Columns",
                                   left_out.size() == 1 ? "is" : "are", fmt::join(left_out, ", ")));
    if (layout.lines_left_out > 0)
        writer_.remark(fmt::format("{} before the data {} left out", count_of_lines(layout.lines_left_out),
                                   layout.lines_left_out == 1 ? "is" : "are"));
    not_numbers_.resize(layout.columns.size());
    instants_.resize(layout.columns.size());
}

void TextTable::take(std::string_view line, std::size_t number, bool is_unfinished) {
    const bool is_blank = layout_.style.delimiter == '\t' ? line.empty() : trimmed(line).empty();
    if (is_blank || line == "\x1a" || layout_.is_comment(line)) return;
    split_cells(line, layout_.style.delimiter, cells_);
    const std::size_t fields = layout_.columns.size();
    if (cells_.size() == fields + 1 && cells_.back().empty()) cells_.pop_back();
    if (cells_.size() != fields) {
        if (is_unfinished && cells_.size() < fields)
            writer_.remark(fmt::format(
                "The last line, {}, is incomplete and left out: the file seems to be cut", number));
        else
            (cells_.size() < fields ? too_few_ : too_many_).add(number);
        return;
    }
    if (!fill_row(number)) return;
    if (is_unfinished) ends_without_line_end_ = number;
    writer_.finish_row(table_);
}

void TextTable::end() {
    const std::size_t fields = layout_.columns.size();
    if (too_few_.count > 0)
        writer_.remark(words_of(too_few_, fmt::format("it has fewer than {} fields and is left out", fields),
                                fmt::format("they have fewer than {} fields and are left out", fields)));
    if (too_many_.count > 0)
        writer_.remark(words_of(too_many_, fmt::format("it has more than {} fields and is left out", fields),
                                fmt::format("they have more than {} fields and are left out", fields)));
    if (no_data_.count > 0)
        writer_.remark(words_of(no_data_, "it has text where numbers belong and is left out",
                                "they have text where numbers belong and are left out"));
    for (std::size_t column = 0; column < fields; ++column) {
        const std::string& name = layout_.columns[column].name;
        if (not_numbers_[column].count > 0)
            writer_.remark(words_of(not_numbers_[column],
                                    fmt::format("'{}' has no number there; it is read as missing", name),
                                    fmt::format("'{}' has no number there; they are read as missing", name)));
        if (instants_[column].origin)
            writer_.assume(fmt::format("'{}' is read as seconds since its first row, {}{}", name,
                                       instants_[column].origin_text, words_on_dates(instants_[column])));
    }
    if (ends_without_line_end_ > 0)
        writer_.remark(
            fmt::format("The last line, {}, has no line end; if the file was cut there, the last number "
                        "of that line is incomplete",
                        ends_without_line_end_));
}

// False where the line has no number or instant at all, but text.
bool TextTable::fill_row(std::size_t number) {
    std::vector<double>& row = writer_.row(table_);
    std::size_t good = 0;
    bad_columns_.clear();
    for (std::size_t column = 0; column < cells_.size(); ++column) {
        const ColumnKind kind = layout_.columns[column].kind;
        if (kind == ColumnKind::text || (slots_[column] < 0 && slots_.size() > 1)) continue;
        double value = 0.0;
        CellKind cell = number_of_cell(cells_[column], layout_.style.decimal_comma, value);
        if (kind == ColumnKind::instants && cell != CellKind::missing)
            cell = instant(cells_[column], instants_[column], value);
        if (cell == CellKind::text) bad_columns_.push_back(column);
        good += cell == CellKind::number ? 1 : 0;
        if (slots_[column] >= 0) row[static_cast<std::size_t>(slots_[column])] = value;
    }
    if (good == 0 && !bad_columns_.empty()) {
        std::fill(row.begin(), row.end(), std::numeric_limits<double>::quiet_NaN());
        no_data_.add(number);
        return false;
    }
    for (const std::size_t column : bad_columns_) not_numbers_[column].add(number);
    return true;
}

CellKind TextTable::instant(std::string_view cell, Instants& column, double& seconds) {
    seconds = std::numeric_limits<double>::quiet_NaN();
    auto now = instant_of_cell(cell, column.order);
    if (!now) return CellKind::text;
    if (!column.origin) {
        column.origin = now;
        column.origin_text = std::string(cell);
    }
    if (column.origin->doubtful_order && !column.order && now->date_days != column.origin->date_days) {
        settle_order(cell, *now, column);
        now = instant_of_cell(cell, column.order);
    }
    seconds = static_cast<double>(now->seconds - column.origin->seconds) +
              (now->fraction_s - column.origin->fraction_s);
    return CellKind::number;
}

// Up to here all rows have the date of the first one, so that their seconds hold in either order.
void TextTable::settle_order(std::string_view cell, const CellInstant& now, Instants& column) {
    if (!now.doubtful_order) {
        for (const DateOrder order : {DateOrder::day_first, DateOrder::month_first})
            if (const auto again = instant_of_cell(cell, order)) column.order = order;
        column.settled_by = "a later date has no other reading";
    } else {
        constexpr long long back_in_time = 1'000'000;
        const auto days_between = [&](DateOrder order) {
            const long long days = instant_of_cell(cell, order)->date_days -
                                   instant_of_cell(column.origin_text, order)->date_days;
            return days >= 0 ? days : back_in_time - days;
        };
        const long long day_first = days_between(DateOrder::day_first);
        const long long month_first = days_between(DateOrder::month_first);
        column.order = day_first < month_first   ? DateOrder::day_first
                       : month_first < day_first ? DateOrder::month_first
                                                 : *now.doubtful_order;
        column.settled_by = day_first == month_first ? "a guess: the other order fits as well"
                                                     : "the next date then follows it more closely";
    }
    column.origin = instant_of_cell(column.origin_text, column.order);
}

std::string TextTable::words_on_dates(const Instants& column) {
    if (!column.origin->doubtful_order) return "";
    const std::chrono::year_month_day date{
        std::chrono::sys_days(std::chrono::days(column.origin->date_days))};
    const bool day_first = *column.origin->doubtful_order == DateOrder::day_first;
    return fmt::format(
        ", taken as {}-{:02}-{:02} with the {} first: {}", static_cast<int>(date.year()),
        static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), day_first ? "day" : "month",
        column.order ? column.settled_by : "a guess, on which no time depends, as all rows have this date");
}

}  // namespace capstan::logs
