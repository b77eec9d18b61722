#pragma once

#include <httplib.h>

#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "capstan/service/bad_request.h"

namespace capstan::service {

using nlohmann::ordered_json;

/// As the commands write JSON: indented, ended by a line break.
void send_json(httplib::Response& response, const ordered_json& json, int status = 200);
void send_text(httplib::Response& response, const std::string& text, const char* content_type);

/// {"error": message}
void send_error(httplib::Response& response, int status, const std::string& message);

/// The body as a JSON object; a BadRequest if it is not one.
nlohmann::json body_of(const httplib::Request& request);

/// A member of the body; a BadRequest that names it if it is missing or of another type.
template <class Value>
Value member(const nlohmann::json& body, const char* name) {
    const auto found = body.find(name);
    if (found == body.end()) throw BadRequest(std::string("'") + name + "' is missing");
    try {
        return found->get<Value>();
    } catch (const nlohmann::json::exception&) {
        throw BadRequest(std::string("'") + name + "' is of another type than expected");
    }
}

/// Integers exactly as written: 1.5 and 4294967297 are refused, not truncated.
template <>
int member<int>(const nlohmann::json& body, const char* name);
template <>
std::vector<int> member<std::vector<int>>(const nlohmann::json& body, const char* name);

/// The number in the path, matched by its pattern; patterns count from 1.
std::int64_t number_in_path(const httplib::Request& request, std::size_t match = 1);

}  // namespace capstan::service
