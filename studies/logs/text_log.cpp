// Delimited text: comma, semicolon, tab, blanks; with or without a head.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/table_writer.h"
#include "capstan/logs/text_layout.h"
#include "capstan/logs/text_lines.h"

namespace capstan::logs {

namespace {

constexpr std::size_t sample_lines = 1000;
constexpr std::size_t sample_bytes = 1u << 20;

bool is_text(std::string_view head, const std::filesystem::path&) {
    std::string unpacked;
    if (is_gzip(head)) head = unpacked = unpacked_head(head);
    if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff")) return true;
    return !head.empty() && std::none_of(head.begin(), head.end(), [](char letter) {
        const auto byte = static_cast<unsigned char>(letter);
        return byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r' && byte != '\f' && byte != 0x1a;
    });
}

// Something that happens on many lines and is told once.
struct LineTally {
    std::size_t count = 0;
    std::size_t first = 0;
    void add(std::size_t line) {
        if (count++ == 0) first = line;
    }
    std::string words(std::string_view one, std::string_view several) const {
        return count == 1 ? fmt::format("Line {}: {}", first, one)
                          : fmt::format("{} lines, the first is line {}: {}", count, first, several);
    }
};

class TextReading {
  public:
    TextReading(const TextLayout& layout, const ReadOptions& options, Log& log)
        : layout_(layout),
          writer_(log, options),
          file_(log.file.string()),
          slots_(layout.columns.size(), -1) {
        table_ = writer_.add_table("");
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
            writer_.remark(fmt::format("{} before the data {} left out",
                                       count_of_lines(layout.lines_left_out),
                                       layout.lines_left_out == 1 ? "is" : "are"));
        not_numbers_.resize(layout.columns.size());
        origins_.resize(layout.columns.size());
        origin_texts_.resize(layout.columns.size());
    }

    void take(std::string_view line, std::size_t number, bool is_unfinished) {
        if (trimmed(line).empty() || line == "\x1a" || layout_.is_comment(line)) return;
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

    void end() {
        const std::size_t fields = layout_.columns.size();
        if (too_few_.count > 0)
            writer_.remark(
                too_few_.words(fmt::format("it has fewer than {} fields and is left out", fields),
                               fmt::format("they have fewer than {} fields and are left out", fields)));
        if (too_many_.count > 0)
            writer_.remark(
                too_many_.words(fmt::format("it has more than {} fields and is left out", fields),
                                fmt::format("they have more than {} fields and are left out", fields)));
        if (no_data_.count > 0)
            writer_.remark(no_data_.words("it has text where numbers belong and is left out",
                                          "they have text where numbers belong and are left out"));
        for (std::size_t column = 0; column < fields; ++column) {
            const std::string& name = layout_.columns[column].name;
            if (not_numbers_[column].count > 0)
                writer_.remark(not_numbers_[column].words(
                    fmt::format("'{}' has no number there; it is read as missing", name),
                    fmt::format("'{}' has no number there; they are read as missing", name)));
            if (!origin_texts_[column].empty())
                writer_.remark(fmt::format("'{}' is read as seconds since its first row, {}", name,
                                           origin_texts_[column]));
        }
        if (ends_without_line_end_ > 0)
            writer_.remark(
                fmt::format("The last line, {}, has no line end; if the file was cut there, the last number "
                            "of that line is incomplete",
                            ends_without_line_end_));
    }

  private:
    static std::string count_of_lines(std::size_t count) {
        return count == 1 ? "A line" : fmt::format("{} lines", count);
    }

    // False where the line has no number or instant at all, but text.
    bool fill_row(std::size_t number) {
        std::vector<double>& row = writer_.row(table_);
        std::size_t good = 0;
        bad_columns_.clear();
        for (std::size_t column = 0; column < cells_.size(); ++column) {
            const ColumnKind kind = layout_.columns[column].kind;
            if (kind == ColumnKind::text || (slots_[column] < 0 && slots_.size() > 1)) continue;
            double value = 0.0;
            CellKind cell = number_of_cell(cells_[column], layout_.style.decimal_comma, value);
            if (kind == ColumnKind::instants && cell != CellKind::missing) cell = instant(column, value);
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

    CellKind instant(std::size_t column, double& seconds) {
        seconds = std::numeric_limits<double>::quiet_NaN();
        const auto now = instant_of_cell(cells_[column]);
        if (!now) return CellKind::text;
        if (!origins_[column]) {
            origins_[column] = now;
            origin_texts_[column] = std::string(cells_[column]);
        }
        seconds = static_cast<double>(now->seconds - origins_[column]->seconds) +
                  (now->fraction_s - origins_[column]->fraction_s);
        return CellKind::number;
    }

    const TextLayout& layout_;
    TableWriter writer_;
    std::string file_;
    int table_ = 0;
    std::vector<int> slots_;  ///< columns of the file: index in the table, or -1
    std::vector<std::string_view> cells_;
    std::vector<std::size_t> bad_columns_;
    std::vector<LineTally> not_numbers_;  ///< columns of the file
    std::vector<std::optional<CellInstant>> origins_;
    std::vector<std::string> origin_texts_;
    LineTally too_few_, too_many_, no_data_;
    std::size_t ends_without_line_end_ = 0;
};

std::vector<std::string> first_lines(TextLines& lines) {
    std::vector<std::string> sample;
    std::size_t bytes = 0;
    std::string_view line;
    while (sample.size() < sample_lines && bytes < sample_bytes && lines.next(line)) {
        bytes += line.size();
        sample.emplace_back(line);
    }
    return sample;
}

void read_text(const std::filesystem::path& path, const ReadOptions& options, Log& log) {
    TextLines lines(open_source(path, options.on_progress), path);
    const std::vector<std::string> sample = first_lines(lines);
    const bool all_read = lines.is_unfinished();
    if (sample.empty()) throw InvalidInput({fmt::format("{}: has no lines", path.string())});
    const TextLayout layout = find_layout(sample, options.text, path.string());
    log.text = {layout.style.delimiter, layout.style.decimal_comma, layout.head_line, options.text.comments};
    TextReading reading(layout, options, log);
    for (std::size_t line = layout.first_data_line; line <= sample.size(); ++line)
        reading.take(sample[line - 1], line, all_read && line == sample.size());
    for (std::string_view line; lines.next(line);) reading.take(line, lines.number(), lines.is_unfinished());
    reading.end();
}

}  // namespace

const LogFormat text_format{"delimited text", ".csv, .txt, .tsv, .dat, also packed with gzip", is_text,
                            read_text};

}  // namespace capstan::logs
