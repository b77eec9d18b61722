// Excel workbooks (.xlsx): a ZIP archive of XML. Each sheet is read as the lines of a text file, so that its
// head, units and columns of text are found in the same way.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/logs/text_lines.h"
#include "capstan/logs/text_table.h"
#include "capstan/xml_archive/xml_archive.h"

namespace capstan::logs {

namespace {

constexpr std::size_t sheet_sample_rows = 1000;
constexpr std::size_t shared_text_bytes = 64u << 20;
constexpr std::size_t longest_cell = 4096;
constexpr int max_row = 1 << 20;  // Excel's own bound

using Attributes = XmlArchive::Attributes;

// Days since 1899-12-30 as ISO 8601, to ten microseconds: a double holds them to one.
std::string instant_of_days(double days) {
    const auto microseconds = 10LL * std::llround(days * 86400e5);
    long long day = microseconds / 86'400'000'000, rest = microseconds % 86'400'000'000;
    const std::chrono::year_month_day date{std::chrono::sys_days(std::chrono::days(day - 25569))};
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:06}", static_cast<int>(date.year()),
                       static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                       rest / 3'600'000'000, rest / 60'000'000 % 60, rest / 1'000'000 % 60, rest % 1'000'000);
}

bool is_date_format(std::string_view code) {
    bool in_text = false, in_brackets = false;
    for (const char letter : code) {
        if (letter == '"') in_text = !in_text;
        if (letter == '[') in_brackets = true;
        if (!in_text && !in_brackets && std::string_view("ymdhsYMDHS").find(letter) != std::string_view::npos)
            return true;
        if (letter == ']') in_brackets = false;
    }
    return false;
}

class WorkbookReading {
  public:
    WorkbookReading(const std::filesystem::path& path, const ReadOptions& options, Log& log)
        : archive_(path, "a workbook"), options_(options), log_(log), writer_(log, options) {}

    void read() {
        std::vector<std::pair<std::string, std::string>> sheets;  // names and relations
        const bool is_workbook =
            archive_.parse("xl/workbook.xml", {.begin = [&](const std::string& name, const Attributes& with) {
                               if (name == "sheet" && sheets.size() < LogLimits::columns)
                                   sheets.emplace_back(value(with, "name"), value(with, "id"));
                               if (name == "workbookPr" && value(with, "date1904").starts_with("1"))
                                   first_day_ = 1462.0;
                           }});
        if (!is_workbook)
            archive_.refuse("is a ZIP archive without an Excel workbook; unpack it with 'unzip'");
        std::map<std::string, std::string> targets;
        archive_.parse("xl/_rels/workbook.xml.rels",
                       {.begin = [&](const std::string& name, const Attributes& with) {
                           if (name == "Relationship" && targets.size() <= LogLimits::columns)
                               targets[value(with, "Id")] = value(with, "Target");
                       }});
        read_shared_texts();
        read_styles();
        for (const auto& [name, relation] : sheets) {
            std::string target = targets[relation];
            target = target.starts_with('/') ? target.substr(1) : "xl/" + target;
            read_sheet(name, target);
            if (options_.on_progress)
                options_.on_progress(static_cast<double>(++sheets_read_) /
                                     static_cast<double>(sheets.size()));
        }
        if (log_.tables.empty()) archive_.refuse("has no sheet with a row of numbers");
    }

  private:
    static std::string value(const Attributes& attributes, const char* name) {
        const auto found = attributes.find(name);
        return found == attributes.end() ? "" : found->second.substr(0, LogLimits::name_bytes);
    }

    void read_shared_texts() {
        std::size_t bytes = 0;
        bool in_text = false;
        const auto begin = [&](const std::string& name, const Attributes&) {
            if (name == "si") shared_.emplace_back();
            if (name == "si") bytes += sizeof(std::string);
            if (bytes > shared_text_bytes) archive_.refuse("has too much text");
            in_text = name == "t";
        };
        const auto take = [&](std::string_view text) {
            if (!in_text || shared_.empty() || shared_.back().size() > longest_cell) return;
            bytes += text.size();
            shared_.back().append(text);
        };
        archive_.parse("xl/sharedStrings.xml",
                       {.begin = begin, .end = [&](const std::string&) { in_text = false; }, .text = take});
    }

    void read_styles() {
        std::set<std::string> dates;
        bool in_cell_formats = false;
        for (const int built_in : {14, 15, 16, 17, 18, 19, 20, 21, 22, 45, 46, 47})
            dates.insert(std::to_string(built_in));
        archive_.parse(
            "xl/styles.xml", {.begin = [&](const std::string& name, const Attributes& with) {
                if (name == "numFmt" && dates.size() < LogLimits::columns &&
                    is_date_format(value(with, "formatCode")))
                    dates.insert(value(with, "numFmtId"));
                if (name == "cellXfs" || name == "cellStyleXfs") in_cell_formats = name == "cellXfs";
                if (name == "xf" && in_cell_formats && is_date_.size() < LogLimits::name_bytes * 64)
                    is_date_.push_back(dates.contains(value(with, "numFmtId")));
            }});
    }

    void read_sheet(const std::string& name, const std::string& part) {
        sample_.clear();
        table_.reset();
        row_ = 0;
        const std::size_t remarks_before = log_.remarks.size();
        const std::size_t assumptions_before = log_.assumptions.size();
        const bool is_there = archive_.parse(
            part,
            {.begin = [&](const std::string& element, const Attributes& with) { begin(name, element, with); },
             .end = [&](const std::string& element) { end(name, element); },
             .text =
                 [&](std::string_view text) {
                     if (in_value_ && cell_.size() < longest_cell) cell_.append(text);
                 }});
        if (!is_there)
            return writer_.remark(fmt::format("Sheet '{}' is left out: the file does not have it", name));
        if (!table_) start_table(name);
        if (table_) table_->end();
        for (std::size_t k = remarks_before; k < log_.remarks.size(); ++k)
            log_.remarks[k] = fmt::format("Sheet '{}': {}", name, log_.remarks[k]);
        for (std::size_t k = assumptions_before; k < log_.assumptions.size(); ++k)
            log_.assumptions[k] = fmt::format("Sheet '{}': {}", name, log_.assumptions[k]);
    }

    void begin(const std::string&, const std::string& element, const Attributes& with) {
        if (element == "row") {
            int stated = 0;
            const std::string number = value(with, "r");
            std::from_chars(number.data(), number.data() + number.size(), stated);
            row_ = std::clamp(std::max(stated, row_ + 1), 1, max_row);
            cells_.clear();
        } else if (element == "c") {
            kind_ = value(with, "t");
            std::size_t column = 0;
            for (const char letter : value(with, "r"))
                if (letter >= 'A' && letter <= 'Z')
                    column = std::min<std::size_t>(26 * column + static_cast<std::size_t>(letter - 'A') + 1,
                                                   1u << 15);
            column_ = column > 0 ? column - 1 : cells_.size();
            const std::string style = value(with, "s");
            std::size_t index = 0;
            std::from_chars(style.data(), style.data() + style.size(), index);
            has_date_ = !style.empty() && index < is_date_.size() && is_date_[index];
            cell_.clear();
        } else if (element == "v" || element == "t") {
            in_value_ = true;
        }
    }

    void end(const std::string& sheet, const std::string& element) {
        if (element == "v" || element == "t") in_value_ = false;
        if (element == "c" && column_ < LogLimits::columns) {
            if (cells_.size() <= column_) cells_.resize(column_ + 1);
            cells_[column_] = cell_text();
        }
        if (element == "row") end_row(sheet);
    }

    std::string cell_text() const {
        std::string text = cell_;
        double number = 0.0;
        if (kind_ == "s") {
            std::size_t index = 0;
            std::from_chars(cell_.data(), cell_.data() + cell_.size(), index);
            text = index < shared_.size() ? shared_[index] : "";
        } else if (has_date_ && (kind_.empty() || kind_ == "n") &&
                   number_of_cell(cell_, false, number) == CellKind::number && std::abs(number) < 2.9e6) {
            text = instant_of_days(number + first_day_);
        }
        for (char& letter : text)
            if (letter == '\t' || letter == '\n' || letter == '\r' || letter == '"') letter = ' ';
        return text;
    }

    // Rows wait until there are enough to find out how the sheet is laid out.
    void end_row(const std::string& sheet) {
        if (table_) return table_->take(line_of(cells_), static_cast<std::size_t>(row_));
        while (sample_.size() + 1 < static_cast<std::size_t>(row_) && sample_.size() < sheet_sample_rows)
            sample_.emplace_back();
        sample_.push_back(cells_);
        if (sample_.size() >= sheet_sample_rows) start_table(sheet);
    }

    std::string line_of(const std::vector<std::string>& cells) const {
        std::string line;
        if (std::all_of(cells.begin(), cells.end(), [](const std::string& cell) { return cell.empty(); }))
            return line;
        for (std::size_t column = 0; column < std::max(width_, cells.size()); ++column) {
            if (column > 0) line += '\t';
            if (column < cells.size()) line += cells[column];
        }
        return line;
    }

    void start_table(const std::string& sheet) {
        width_ = 0;
        for (const auto& cells : sample_) width_ = std::max(width_, cells.size());
        std::vector<std::string> lines;
        for (const auto& cells : sample_) lines.push_back(line_of(cells));
        if (lines.empty()) return writer_.remark("it is empty");
        TextFormat format;
        format.delimiter = '\t';
        format.decimal_comma = false;
        format.comments = "\x01";  // none
        format.head_line = options_.text.head_line;
        try {
            layout_ = find_layout(lines, format, sheet);
        } catch (const InvalidInput&) {
            writer_.remark("it is left out: it has no row of numbers");
            return;
        }
        table_ = std::make_unique<TextTable>(layout_, writer_, sheet);
        for (std::size_t row = layout_.first_data_line; row <= lines.size(); ++row)
            table_->take(lines[row - 1], row);
    }

    XmlArchive archive_;
    const ReadOptions& options_;
    Log& log_;
    TableWriter writer_;
    std::vector<std::string> shared_;
    std::vector<bool> is_date_;  ///< cell formats
    double first_day_ = 0.0;
    std::size_t sheets_read_ = 0;
    // Of the sheet that is being read.
    std::vector<std::vector<std::string>> sample_;
    std::size_t width_ = 0;
    TextLayout layout_;
    std::unique_ptr<TextTable> table_;
    int row_ = 0;
    std::vector<std::string> cells_;
    std::size_t column_ = 0;
    std::string kind_, cell_;
    bool has_date_ = false;
    bool in_value_ = false;
};

bool is_xlsx(std::string_view head, const std::filesystem::path&) {
    return head.starts_with("PK\x03\x04");
}

void read_xlsx(const std::filesystem::path& path, const ReadOptions& options, Log& log) {
    WorkbookReading(path, options, log).read();
}

}  // namespace

const LogFormat xlsx_format{"Excel workbook", ".xlsx", is_xlsx, read_xlsx};

}  // namespace capstan::logs
