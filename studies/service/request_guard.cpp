#include "capstan/service/request_guard.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "capstan/http/request.h"

namespace capstan::service {

namespace {

// Only these take files.
constexpr std::array<std::string_view, 8> upload_paths{
    "/api/diagnoses",         "/api/diagnoses/cost", "/api/estimates",        "/api/estimates/cost",
    "/api/import/suggestion", "/api/import/trial",   "/api/import/diagnosis", "/api/import/diagnosis/cost"};

bool writes(const RequestHead& request) {
    return request.method != "GET" && request.method != "HEAD";
}

// Names that can only mean this service. If a token is required, any name is accepted.
bool host_is_ours(const RequestHead& request, const Access& access) {
    if (!access.token.empty()) return true;
    const std::string given = http::lower_case(request.host);
    for (const char* name : {"127.0.0.1", "localhost", "[::1]"}) {
        if (given == fmt::format("{}:{}", name, access.port)) return true;
        if (access.port == 80 && given == name) return true;
    }
    return false;
}

bool origin_is_ours(const RequestHead& request) {
    if (request.fetch_site == "cross-site" || request.fetch_site == "same-site") return false;
    return request.origin.empty() ||
           http::lower_case(request.origin) == "http://" + http::lower_case(request.host);
}

bool is_loopback_number(std::string_view host) {
    in_addr number{};
    return ::inet_pton(AF_INET, std::string(host).c_str(), &number) == 1 &&
           (ntohl(number.s_addr) >> 24) == 127;
}

}  // namespace

std::optional<Refusal> refuse_body(const RequestHead& request) {
    const bool upload =
        std::find(upload_paths.begin(), upload_paths.end(), request.path) != upload_paths.end();
    if (!request.transfer_encoding.empty() || (writes(request) && !request.content_length))
        return Refusal{411, "The body needs a Content-Length."};
    const std::size_t limit = upload ? largest_upload_bytes : largest_text_bytes;
    if (request.content_length && *request.content_length > limit)
        return Refusal{
            413, fmt::format("The body has {} bytes; at most {} are taken.", *request.content_length, limit)};
    if (!writes(request) || request.content_length == 0u) return std::nullopt;
    const std::string_view expected = upload ? "multipart/form-data" : "application/json";
    if (!http::lower_case(request.content_type).starts_with(expected))
        return Refusal{415, fmt::format("The body must be {}.", expected)};
    return std::nullopt;
}

bool is_loopback(std::string_view host) {
    return host == "localhost" || host == "::1" || is_loopback_number(host);
}

std::optional<Refusal> refuse_origin(const RequestHead& request, const Access& access) {
    if (!host_is_ours(request, access))
        return Refusal{
            403, fmt::format("This service is http://127.0.0.1:{}, not '{}'.", access.port, request.host)};
    if (!origin_is_ours(request)) return Refusal{403, "Pages of other sites may not use this service."};
    return std::nullopt;
}

}  // namespace capstan::service
