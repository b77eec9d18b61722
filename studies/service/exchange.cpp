#include "capstan/service/exchange.h"

#include <charconv>

namespace capstan::service {

void send_text(httplib::Response& response, const std::string& text, const char* content_type) {
    response.status = 200;
    response.set_content(text, content_type);
}

void send_json(httplib::Response& response, const ordered_json& json, int status) {
    response.status = status;
    response.set_content(json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n",
                         "application/json");
}

void send_error(httplib::Response& response, int status, const std::string& message) {
    send_json(response, {{"error", message}}, status);
}

nlohmann::json body_of(const httplib::Request& request) {
    auto body = nlohmann::json::parse(request.body, nullptr, false);
    if (!body.is_object()) throw BadRequest("the body must be a JSON object");
    return body;
}

std::int64_t number_in_path(const httplib::Request& request, std::size_t match) {
    const std::string text = request.matches[match];
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size())
        throw BadRequest("there is no number " + text, 404);
    return number;
}

}  // namespace capstan::service
