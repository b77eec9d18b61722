#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace capstan::logs {

/// How the cells of a line are separated and numbers written.
struct CellStyle {
    char delimiter = ',';  ///< ' ': any number of blanks or tabs
    bool decimal_comma = false;
};

/// The cells of a line, trimmed, the quotes around a cell removed.
void split_cells(std::string_view line, char delimiter, std::vector<std::string_view>& cells);

enum class CellKind { number, missing, text };

/// What a cell is. `number` gets its value; NaN for a missing one (empty, "nan", "inf", "-", "NA") and text.
CellKind number_of_cell(std::string_view cell, bool decimal_comma, double& number);

/// In which order a date has its day and its month, where the year stands last.
enum class DateOrder { day_first, month_first };

/// An instant of ISO 8601 ("2024-05-01T10:00:00.250Z", a blank instead of the T), a date with the year last
/// ("01.05.2024 10:00:00.250", "5/1/2024 1:00:00 PM") or a time of day ("10:00:00.250").
struct CellInstant {
    long long seconds = 0;  ///< since 1970-01-01, or since midnight
    double fraction_s = 0.0;
    bool is_time_of_day = false;
    long long date_days = 0;  ///< of the date as it is written, since 1970-01-01
    /// How the date was read, where the other order would give a different one.
    std::optional<DateOrder> doubtful_order{};
};

/// `order`: of dates with the year last; nothing: the one that is possible, and where both are, the usual
/// one: the month first between slashes, else the day.
std::optional<CellInstant> instant_of_cell(std::string_view cell, std::optional<DateOrder> order = {});

std::string_view trimmed(std::string_view text);

/// The name of a column and the unit that it states in brackets at its end: "Torque [N m]", "angle (deg)".
/// Round brackets are left where they hold no unit: "x(1)".
struct NameAndUnit {
    std::string name;
    std::string unit;
};
NameAndUnit name_and_unit(std::string_view head);

/// Whether a cell is the symbol of a unit, with or without brackets: "[N m]", "deg", "counts".
bool is_unit(std::string_view cell);

/// Without the brackets around it.
std::string without_brackets(std::string_view unit);

}  // namespace capstan::logs
