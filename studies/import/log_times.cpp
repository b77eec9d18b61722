#include "capstan/import/log_times.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "capstan/import/log_files.h"
#include "capstan/import/units.h"

namespace capstan::imports {

namespace {

constexpr std::array time_units = {"s", "ms", "us", "ns"};
constexpr double longest_usual_period_s = 1.0 / 15.0;
constexpr double shortest_usual_period_s = 1.0 / 20000.0;

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

}  // namespace

int time_column(const logs::LogTable& table, const std::string& wanted) {
    if (!wanted.empty()) return find_column(table, wanted);
    for (const char* usual :
         {"header.stamp", "log_time", "t", "time", "timestamp", "stamp", "time_s", "seconds", "time_ms",
          "t_ms", "time_us", "t_us", "time_ns", "t_ns", "millis", "micros", "%time"}) {
        for (std::size_t column = 0; column < table.columns.size(); ++column) {
            if (lower(table.columns[column].name) == usual) return static_cast<int>(column);
        }
    }
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
        const std::string name = lower(table.columns[column].name);
        if (name.find("time") != std::string::npos || name.find("zeit") != std::string::npos)
            return static_cast<int>(column);
    }
    return -1;
}

double seconds_per_unit(const logs::LogColumn& column, const std::string& stated) {
    const auto time_unit = [](std::string_view text) -> std::optional<double> {
        const auto unit = find_unit(text);
        if (!unit || unit->quantity != Quantity::time) return std::nullopt;
        return unit->si;
    };
    if (const auto unit = time_unit(stated)) return *unit;
    if (const auto unit = time_unit(stated_unit(column))) return *unit;
    if (column.name == "%time") return 1e-9;  // rostopic echo -p
    return time_unit(column.name).value_or(1.0);
}

bool is_usual_period(double period_s) {
    return period_s >= shortest_usual_period_s && period_s <= longest_usual_period_s;
}

std::string_view usual_time_unit(double period) {
    for (const char* unit : time_units) {
        if (is_usual_period(period * find_unit(unit)->si)) return unit;
    }
    return "";
}

std::string_view time_unit_name(double seconds) {
    for (const char* unit : time_units) {
        if (find_unit(unit)->si == seconds) return unit;
    }
    return "";
}

}  // namespace capstan::imports
