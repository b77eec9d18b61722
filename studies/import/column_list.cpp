#include "capstan/import/column_list.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "capstan/import/log_files.h"
#include "capstan/logs/log.h"

namespace capstan::imports {

namespace {

constexpr std::size_t drawn_points = 60000;    // of all columns together
constexpr std::size_t max_drawn_points = 400;  // of a column
constexpr std::size_t min_drawn_points = 16;

// The extremes of the rows between two drawn places.
class Stretch {
  public:
    void add(std::size_t row, double value) {
        if (count_ == 0 || value < low_) low_ = value, low_row_ = row;
        if (count_ == 0 || value > high_) high_ = value, high_row_ = row;
        ++count_;
    }
    void draw(ListedColumn& column) {
        if (count_ == 0) return;
        draw_one(column, std::min(low_row_, high_row_), low_row_ < high_row_ ? low_ : high_);
        if (low_row_ != high_row_)
            draw_one(column, std::max(low_row_, high_row_), low_row_ < high_row_ ? high_ : low_);
        count_ = 0;
    }

  private:
    static void draw_one(ListedColumn& column, std::size_t row, double value) {
        column.drawn_row.push_back(static_cast<double>(row));
        column.drawn_value.push_back(value);
    }
    double low_ = 0.0, high_ = 0.0;
    std::size_t low_row_ = 0, high_row_ = 0, count_ = 0;
};

void read_column(const logs::LogColumn& from, std::size_t points, ListedColumn& column) {
    const std::size_t rows_each = std::max<std::size_t>(1, 2 * column.rows / points);
    logs::NumberReader reader(from.values);
    Stretch stretch;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    double value = 0.0;
    for (std::size_t row = 0; reader.next(value); ++row) {
        if (row % rows_each == 0) stretch.draw(column);
        if (!std::isfinite(value)) {
            ++column.missing;
            continue;
        }
        stretch.add(row, value);
        low = std::min(low, value);
        high = std::max(high, value);
    }
    stretch.draw(column);
    if (low <= high) column.low = low, column.high = high;
}

}  // namespace

ColumnList list_columns(const std::vector<std::filesystem::path>& files,
                        const std::function<void(const std::string&, double)>& on_progress) {
    ColumnList list;
    std::vector<std::vector<std::string>> names;  // of the files that were read
    for (std::size_t file = 0; file < files.size(); ++file) {
        logs::ReadOptions reading;
        if (on_progress)
            reading.on_progress = [&](double part) {
                on_progress("reading",
                            (static_cast<double>(file) + part) / static_cast<double>(files.size()));
            };
        const logs::Log log = logs::read_log(files[file], reading);
        ListedLog& listed = list.logs.emplace_back();
        listed.file = files[file].filename().string();
        listed.format = log.format;
        listed.remarks = log.remarks;
        listed.remarks.insert(listed.remarks.end(), log.assumptions.begin(), log.assumptions.end());
        names.push_back(column_names(log));
        const auto same = std::find(names.begin(), names.end() - 1, names.back());
        if (same != names.end() - 1) {
            listed.same_columns_as = list.logs[static_cast<std::size_t>(same - names.begin())].file;
            continue;
        }
        const std::size_t points =
            std::clamp(drawn_points / std::max<std::size_t>(names.back().size() * files.size(), 1),
                       min_drawn_points, max_drawn_points);
        for (const logs::LogTable& table : log.tables) {
            for (const logs::LogColumn& from : table.columns) {
                ListedColumn& column = list.columns.emplace_back();
                column.file = listed.file;
                column.table = table.name;
                column.name = from.name;
                column.unit = stated_unit(from);
                column.rows = table.rows;
                read_column(from, points, column);
            }
        }
    }
    return list;
}

}  // namespace capstan::imports
