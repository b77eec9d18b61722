#include <algorithm>
#include <array>

#include "capstan/logs/text_cells.h"

namespace capstan::logs {

namespace {

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
