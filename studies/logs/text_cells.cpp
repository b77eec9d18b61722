#include "capstan/logs/text_cells.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace capstan::logs {

namespace {

constexpr std::size_t longest_number = 64;

bool is_blank(char letter) {
    return letter == ' ' || letter == '\t';
}

bool is_missing(std::string_view cell) {
    constexpr std::array<std::string_view, 19> words{
        "-", "--", "nan",     "inf",    "infinity", "na",      "n/a",     "#n/a",    "null", "none",
        "?", ".",  "1.#qnan", "1.#ind", "1.#inf",   "#div/0!", "#value!", "missing", "nat"};
    if (cell.empty()) return true;
    if (cell.size() > 1 && (cell[0] == '-' || cell[0] == '+') && cell != "--") cell.remove_prefix(1);
    if (cell.size() > 9) return false;
    std::string small(cell);
    for (char& letter : small)
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    return std::find(words.begin(), words.end(), small) != words.end();
}

// "1.234,5", "-12.345.678,9": a dot before each three digits, and a decimal comma.
bool has_dots_of_thousands(std::string_view cell) {
    if (!cell.empty() && (cell[0] == '-' || cell[0] == '+')) cell.remove_prefix(1);
    const std::size_t comma = cell.find(',');
    const std::size_t dot = cell.find('.');
    if (comma == std::string_view::npos || dot == std::string_view::npos || dot == 0 || dot > 3 ||
        (comma - dot) % 4 != 0)
        return false;
    for (std::size_t k = 0; k < comma; ++k)
        if ((cell[k] == '.') != (k >= dot && (k - dot) % 4 == 0)) return false;
    return true;
}

// What from_chars leaves: a leading +, a decimal comma, Fortran's D, numbers beyond or below a double's
// range.
CellKind number_of_unusual_cell(std::string_view cell, bool decimal_comma, double& number) {
    if (is_missing(cell)) return CellKind::missing;
    if (cell.size() > longest_number) return CellKind::text;
    const bool has_thousands = decimal_comma && has_dots_of_thousands(cell);
    char copy[longest_number + 1];
    std::size_t length = 0;
    bool has_digit = false;
    for (const char letter : cell) {
        const bool digit = letter >= '0' && letter <= '9';
        has_digit = has_digit || digit;
        if (!digit && std::strchr("+-.,eEdD", letter) == nullptr) return CellKind::text;
        if (letter == ',' && !decimal_comma) return CellKind::text;
        if (letter == '.' && has_thousands) continue;
        if (letter == '.' && decimal_comma && cell.find(',') != std::string_view::npos) return CellKind::text;
        copy[length++] = letter == ',' ? '.' : letter == 'd' || letter == 'D' ? 'e' : letter;
    }
    const char* begin = copy + (copy[0] == '+' && length > 1 && copy[1] != '-' ? 1 : 0);
    double value = 0.0;
    const auto [end, error] = std::from_chars(begin, copy + length, value);
    if (!has_digit || end != copy + length || error == std::errc::invalid_argument) return CellKind::text;
    if (error == std::errc::result_out_of_range) {
        const std::string_view digits(begin, static_cast<std::size_t>(copy + length - begin));
        const std::size_t exponent = digits.find_first_of("eE");
        const bool is_tiny =
            exponent != std::string_view::npos && digits.substr(exponent + 1).starts_with('-');
        if (!is_tiny) return CellKind::missing;
        value = 0.0;
    }
    number = value;
    return CellKind::number;
}

bool digits_at(std::string_view cell, std::size_t at, std::size_t count, int& value) {
    if (at + count > cell.size()) return false;
    value = 0;
    for (std::size_t k = at; k < at + count; ++k) {
        if (cell[k] < '0' || cell[k] > '9') return false;
        value = 10 * value + (cell[k] - '0');
    }
    return true;
}

// A number of one or two digits from `at` on, which moves behind it.
bool one_or_two_digits(std::string_view cell, std::size_t& at, int& value) {
    const std::size_t count = digits_at(cell, at, 2, value) ? 2 : 1;
    if (count == 1 && !digits_at(cell, at, 1, value)) return false;
    at += count;
    return true;
}

// " PM" from `at` on, which moves behind it; false where the hour does not go with it.
bool half_of_day(std::string_view cell, std::size_t& at, int& hour) {
    std::size_t next = at;
    while (next < cell.size() && is_blank(cell[next])) ++next;
    if (next + 2 > cell.size() || (cell[next + 1] | 0x20) != 'm') return true;
    const int letter = cell[next] | 0x20;
    if (letter != 'a' && letter != 'p') return true;
    if (hour < 1 || hour > 12) return false;
    hour = hour % 12 + (letter == 'p' ? 12 : 0);
    at = next + 2;
    return true;
}

// "10:00", "10:00:00", "10:00:00.250", "1:00:00 PM" from `at` on, which moves behind it.
bool time_of_day(std::string_view cell, std::size_t& at, CellInstant& instant) {
    int hour = 0, minute = 0, second = 0;
    if (!one_or_two_digits(cell, at, hour) || at >= cell.size() || cell[at] != ':' ||
        !digits_at(cell, at + 1, 2, minute) || hour > 24 || minute > 59)
        return false;
    at += 3;
    if (at < cell.size() && cell[at] == ':') {
        if (!digits_at(cell, at + 1, 2, second) || second > 60) return false;
        at += 3;
        if (at < cell.size() && (cell[at] == '.' || cell[at] == ',')) {
            double digits = 0.0, scale = 1.0;
            for (++at; at < cell.size() && cell[at] >= '0' && cell[at] <= '9'; ++at) {
                if (scale >= 1e15) continue;  // finer than a double holds
                digits = 10.0 * digits + (cell[at] - '0');
                scale *= 10.0;
            }
            instant.fraction_s = digits / scale;
        }
    }
    if (!half_of_day(cell, at, hour)) return false;
    instant.seconds += hour * 3600 + minute * 60 + second;
    return true;
}

std::optional<long long> days_of(int year, int month, int day) {
    const std::chrono::year_month_day date{std::chrono::year(year),
                                           std::chrono::month(static_cast<unsigned>(month)),
                                           std::chrono::day(static_cast<unsigned>(day))};
    if (!date.ok()) return std::nullopt;
    return std::chrono::sys_days(date).time_since_epoch().count();
}

// "2024-05-01", "2024/05/01" at the beginning; `at` moves behind it.
bool date_with_year_first(std::string_view cell, std::size_t& at, CellInstant& instant) {
    int year = 0, month = 0, day = 0;
    if (cell.size() < 10 || (cell[4] != '-' && cell[4] != '/') || cell[7] != cell[4] ||
        !digits_at(cell, 0, 4, year) || !digits_at(cell, 5, 2, month) || !digits_at(cell, 8, 2, day))
        return false;
    const auto days = days_of(year, month, day);
    instant.date_days = days.value_or(0);
    at = 10;
    return days.has_value();
}

// "01.05.2024", "5/1/2024", "01-05-2024" at the beginning; `at` moves behind it.
bool date_with_year_last(std::string_view cell, std::size_t& at, std::optional<DateOrder> order,
                         CellInstant& instant) {
    int first = 0, second = 0, year = 0;
    if (!one_or_two_digits(cell, at, first) || at >= cell.size()) return false;
    const char between = cell[at];
    if ((between != '.' && between != '/' && between != '-') || !one_or_two_digits(cell, ++at, second) ||
        at >= cell.size() || cell[at] != between || !digits_at(cell, at + 1, 4, year))
        return false;
    at += 5;
    const auto day_first = days_of(year, second, first), month_first = days_of(year, first, second);
    const bool is_doubtful = day_first && month_first && *day_first != *month_first;
    DateOrder taken = between == '/' ? DateOrder::month_first : DateOrder::day_first;
    if (!day_first) taken = DateOrder::month_first;
    if (!month_first) taken = DateOrder::day_first;
    taken = order.value_or(taken);
    const auto days = taken == DateOrder::day_first ? day_first : month_first;
    instant.date_days = days.value_or(0);
    if (is_doubtful) instant.doubtful_order = taken;
    return days.has_value();
}

constexpr std::size_t longest_unit = 32;

// Symbols of what laboratories log, compared without case, blanks, dots and stars.
constexpr std::array<std::string_view, 96> unit_symbols{
    "s",       "sec",   "secs",   "second",  "seconds", "ms",    "msec",   "us",      "µs",    "μs",
    "ns",      "min",   "h",      "n",       "mn",      "kn",    "newton", "newtons", "lb",    "lbf",
    "nm",      "mnm",   "nmm",    "ncm",     "n-m",     "n-mm",  "kgf",    "gf",      "m",     "mm",
    "cm",      "um",    "µm",     "μm",      "in",      "inch",  "rad",    "mrad",    "rads",  "radian",
    "radians", "deg",   "degs",   "degree",  "degrees", "°",     "rev",    "revs",    "turns", "v",
    "mv",      "uv",    "volt",   "volts",   "a",       "ma",    "amp",    "amps",    "hz",    "khz",
    "rpm",     "count", "counts", "cnt",     "cnts",    "ticks", "tick",   "pulses",  "lsb",   "g",
    "kg",      "gram",  "grams",  "pa",      "kpa",     "mpa",   "bar",    "%",       "c",     "°c",
    "degc",    "k",     "w",      "j",       "rad/s",   "deg/s", "°/s",    "m/s",     "mm/s",  "m/s2",
    "m/s^2",   "m/s²",  "rad/s2", "rad/s^2", "deg/s2",  "1"};

bool is_whole_number(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char letter) {
        return (letter >= '0' && letter <= '9') || letter == ',' || letter == ':' || letter == ' ';
    });
}

}  // namespace

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

void split_cells(std::string_view line, char delimiter, std::vector<std::string_view>& cells) {
    cells.clear();
    const bool has_quotes = std::memchr(line.data(), '"', line.size()) != nullptr;
    if (delimiter == ' ') line = trimmed(line);
    if (delimiter == ' ' && line.empty()) return;
    std::size_t at = 0;
    while (true) {
        while (at < line.size() && is_blank(line[at]) && line[at] != delimiter) ++at;
        if (has_quotes && at < line.size() && line[at] == '"') {
            const std::size_t begin = ++at;
            std::size_t end = line.find('"', at);
            while (end != std::string_view::npos && end + 1 < line.size() && line[end + 1] == '"')
                end = line.find('"', end + 2);
            at = end == std::string_view::npos ? line.size() : end + 1;
            cells.push_back(trimmed(line.substr(begin, std::min(end, line.size()) - begin)));
            while (at < line.size() && line[at] != delimiter && !(delimiter == ' ' && is_blank(line[at])))
                ++at;
        } else if (delimiter == ' ') {
            const std::size_t begin = at;
            while (at < line.size() && !is_blank(line[at])) ++at;
            cells.push_back(line.substr(begin, at - begin));
        } else {
            const void* found = std::memchr(line.data() + at, delimiter, line.size() - at);
            const std::size_t end =
                found ? static_cast<std::size_t>(static_cast<const char*>(found) - line.data()) : line.size();
            cells.push_back(trimmed(line.substr(at, end - at)));
            at = end;
        }
        if (at >= line.size()) break;
        ++at;
        if (delimiter == ' ')
            while (at < line.size() && is_blank(line[at])) ++at;
    }
}

CellKind number_of_cell(std::string_view cell, bool decimal_comma, double& number) {
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
    if (error == std::errc() && end == cell.data() + cell.size() && std::isfinite(number))
        return CellKind::number;
    number = std::numeric_limits<double>::quiet_NaN();
    return number_of_unusual_cell(cell, decimal_comma, number);
}

std::optional<CellInstant> instant_of_cell(std::string_view cell, std::optional<DateOrder> order) {
    CellInstant instant;
    std::size_t at = 0;
    const std::size_t colon = cell.find(':');
    if (cell.size() >= 4 && (colon == 1 || colon == 2)) {
        instant.is_time_of_day = true;
        if (!time_of_day(cell, at, instant) || at != cell.size()) return std::nullopt;
        return instant;
    }
    const bool is_date =
        date_with_year_first(cell, at, instant) || date_with_year_last(cell, at = 0, order, instant);
    if (!is_date) return std::nullopt;
    instant.seconds = instant.date_days * 86400LL;
    if (at == cell.size()) return instant;
    if (cell[at] != 'T' && cell[at] != ' ') return std::nullopt;
    at = cell.find_first_not_of(" ", at + 1);
    if (at == std::string_view::npos || !time_of_day(cell, at, instant)) return std::nullopt;
    std::string_view zone = trimmed(cell.substr(at));
    if (zone.empty() || zone == "Z" || zone == "UTC") return instant;
    int hours = 0, minutes = 0;
    if ((zone[0] != '+' && zone[0] != '-') || !digits_at(zone, 1, 2, hours)) return std::nullopt;
    std::string_view rest = zone.substr(3);
    if (rest.starts_with(':')) rest.remove_prefix(1);
    if (!rest.empty() && (rest.size() != 2 || !digits_at(rest, 0, 2, minutes))) return std::nullopt;
    instant.seconds -= (zone[0] == '-' ? -1 : 1) * (hours * 3600 + minutes * 60);
    return instant;
}

std::string without_brackets(std::string_view unit) {
    unit = trimmed(unit);
    if (unit.size() >= 2 &&
        ((unit.front() == '[' && unit.back() == ']') || (unit.front() == '(' && unit.back() == ')')))
        unit = trimmed(unit.substr(1, unit.size() - 2));
    return std::string(unit);
}

bool is_unit(std::string_view cell) {
    const std::string bare = without_brackets(cell);
    if (bare.size() > longest_unit) return false;
    std::string symbol;
    for (const char letter : bare)
        if (letter != ' ' && letter != '.' && letter != '*')
            symbol += letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    if (std::find(unit_symbols.begin(), unit_symbols.end(), symbol) != unit_symbols.end()) return true;
    return cell.size() > 2 && cell.front() == '[' && cell.back() == ']' && !is_whole_number(bare);
}

NameAndUnit name_and_unit(std::string_view head) {
    head = trimmed(head);
    NameAndUnit all{std::string(head), ""};
    if (head.size() < 3) return all;
    const char closing = head.back();
    if (closing != ']' && closing != ')') return all;
    const std::size_t opening = head.rfind(closing == ']' ? '[' : '(');
    if (opening == std::string_view::npos || opening == 0) return all;
    const std::string_view unit = trimmed(head.substr(opening + 1, head.size() - opening - 2));
    const std::string_view name = trimmed(head.substr(0, opening));
    if (name.empty() || unit.empty() || unit.size() > longest_unit || is_whole_number(unit)) return all;
    const bool is_apart = head[opening - 1] == ' ';
    if (closing == ')' && !is_apart && !is_unit(unit)) return all;
    return {std::string(name), std::string(unit)};
}

}  // namespace capstan::logs
