#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace capstan::http {

/// What a request line asks for.
struct Target {
    std::string path;                               ///< decoded
    std::map<std::string, std::string> parameters;  ///< of the query, decoded; of several of a name the first
};

/// Nothing if it is not a path of this server, or if an escape (%2f) is damaged or stands for a zero byte.
std::optional<Target> parse_target(std::string_view text);

}  // namespace capstan::http
