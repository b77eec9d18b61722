#include "capstan/service/exchange.h"

#include <limits>

#include "capstan/platform/parsed_number.h"

namespace capstan::service {

namespace {

int integer_of(const nlohmann::json& value, const char* name) {
    using Limits = std::numeric_limits<int>;
    const bool fits = value.is_number_unsigned()
                          ? value.get<std::uint64_t>() <= static_cast<std::uint64_t>(Limits::max())
                          : value.is_number_integer() && value.get<std::int64_t>() >= Limits::min() &&
                                value.get<std::int64_t>() <= Limits::max();
    if (!fits) throw BadRequest(std::string("'") + name + "' must be an integer of 32 bits");
    return value.get<int>();
}

const nlohmann::json& found_in(const nlohmann::json& body, const char* name) {
    const auto found = body.find(name);
    if (found == body.end()) throw BadRequest(std::string("'") + name + "' is missing");
    return *found;
}

}  // namespace

void send_text(http::Response& response, std::string text, const char* content_type) {
    response.status = 200;
    response.content_type = content_type;
    response.text = std::make_shared<http::KeptText>(std::move(text));
}

void send_kept(http::Response& response, std::shared_ptr<const http::KeptText> text,
               const char* content_type) {
    response.status = 200;
    response.content_type = content_type;
    response.text = std::move(text);
    response.is_kept = true;
}

void send_json(http::Response& response, const ordered_json& json, int status) {
    send_text(response, json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n",
              "application/json");
    response.status = status;
}

void send_error(http::Response& response, int status, const std::string& message) {
    send_json(response, {{"error", message}}, status);
}

nlohmann::json body_of(const http::Request& request) {
    auto body = nlohmann::json::parse(request.body, nullptr, false);
    if (!body.is_object()) throw BadRequest("the body must be a JSON object");
    return body;
}

template <>
int member<int>(const nlohmann::json& body, const char* name) {
    return integer_of(found_in(body, name), name);
}

template <>
std::vector<int> member<std::vector<int>>(const nlohmann::json& body, const char* name) {
    const nlohmann::json& list = found_in(body, name);
    if (!list.is_array()) throw BadRequest(std::string("'") + name + "' is of another type than expected");
    std::vector<int> numbers;
    for (const nlohmann::json& value : list) numbers.push_back(integer_of(value, name));
    return numbers;
}

std::int64_t number_in_path(const http::Request& request, std::size_t which) {
    const std::string& text = request.path_values.at(which);
    const auto number = parsed_number<std::int64_t>(text);
    if (!number) throw BadRequest("there is no number " + text, 404);
    return *number;
}

}  // namespace capstan::service
