#include "capstan/config/config_key.h"

#include <fmt/format.h>

#include <cmath>

namespace capstan::config {

std::string Limits::words() const {
    const auto number = [](double value) { return fmt::format("{}", value); };
    const bool open_above = std::isinf(high) || high >= 1e7;
    if (std::isinf(low)) return open_above ? "" : "at most " + number(high);
    if (open_above) return low_is_allowed ? number(low) + " or more" : "above " + number(low);
    return (low_is_allowed ? "" : "above ") + number(low) + " to " + number(high);
}

}  // namespace capstan::config
