#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "capstan/http/response.h"
#include "capstan/service/bad_request.h"

namespace capstan::service {

using nlohmann::ordered_json;

/// As the commands write JSON: indented, ended by a line break.
void send_json(http::Response& response, const ordered_json& json, int status = 200);
void send_text(http::Response& response, std::string text, const char* content_type);
/// A text that is sent again, and compressed for clients that accept it.
void send_kept(http::Response& response, std::shared_ptr<const http::KeptText> text,
               const char* content_type);

/// {"error": message}
void send_error(http::Response& response, int status, const std::string& message);

/// The body as a JSON object; a BadRequest if it is not one.
nlohmann::json body_of(const http::Request& request);

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

/// A number in the path, the first unless another is asked for. A BadRequest (404) if it is larger than any
/// number of ours.
std::int64_t number_in_path(const http::Request& request, std::size_t which = 0);

}  // namespace capstan::service
