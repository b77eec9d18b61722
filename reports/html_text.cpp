#include "capstan/reports/html_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace capstan::reports {

std::string escape_html(std::string_view text) {
    std::string safe;
    safe.reserve(text.size());
    for (const char letter : text) {
        switch (letter) {
            case '&':
                safe += "&amp;";
                break;
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '"':
                safe += "&quot;";
                break;
            case '\'':
                safe += "&#39;";
                break;
            default:
                safe += letter;
        }
    }
    return safe;
}

// Two thousand repetitions determine about three significant digits.
std::string plain_number(double value, int significant_digits) {
    if (value == 0) return "0";
    const int digits_before_point = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
    const int decimals = std::clamp(significant_digits - digits_before_point, 0, 6);
    return fmt::format("{:.{}f}", value, decimals);
}

std::string newtons(double value_N) {
    return plain_number(value_N) + " N";
}

std::string newtons_between(double low_N, double high_N) {
    return plain_number(low_N) + " to " + plain_number(high_N) + " N";
}

std::string percent(double fraction) {
    return fmt::format("{:.3g} %", 100 * fraction);
}

std::string regime_title(std::string_view regime) {
    if (regime == "mass") return "Mass motion";
    if (regime == "partial_proximal") return "Partial motion, proximal side";
    if (regime == "partial_distal") return "Partial motion, distal side";
    if (regime == "partial_both") return "Partial motion, both sides";
    return std::string(regime);
}

}  // namespace capstan::reports
