#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace capstan::cli {

/// Indented, ended by a line break. Bytes that are no UTF-8 become the replacement character.
inline std::string json_text(const nlohmann::ordered_json& json) {
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace capstan::cli
