#include "capstan/service/request_guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace capstan::service {

namespace {

constexpr std::string_view bearer = "Bearer ";
constexpr std::string_view cookie_name = "capstan_token=";
// Only these take files.
constexpr std::array<std::string_view, 4> upload_paths{"/api/diagnoses", "/api/import/suggestion",
                                                       "/api/import/trial", "/api/import/diagnosis"};

std::string lower(std::string_view text) {
    std::string small(text);
    std::transform(small.begin(), small.end(), small.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    return small;
}

bool writes(const RequestHead& request) {
    return request.method != "GET" && request.method != "HEAD";
}

// Names that can only mean this service. If a token is required, any name is accepted.
bool host_is_ours(const RequestHead& request, const Access& access) {
    if (!access.token.empty()) return true;
    const std::string given = lower(request.host);
    for (const char* name : {"127.0.0.1", "localhost", "[::1]"}) {
        if (given == fmt::format("{}:{}", name, access.port)) return true;
        if (access.port == 80 && given == name) return true;
    }
    return false;
}

bool origin_is_ours(const RequestHead& request) {
    if (request.fetch_site == "cross-site" || request.fetch_site == "same-site") return false;
    return request.origin.empty() || lower(request.origin) == "http://" + lower(request.host);
}

bool has_token(const RequestHead& request, const Access& access) {
    if (access.token.empty()) return true;
    if (request.authorization.starts_with(bearer))
        return same_secret(std::string_view(request.authorization).substr(bearer.size()), access.token);
    return same_secret(token_of_cookie(request.cookie), access.token);
}

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
    if (!lower(request.content_type).starts_with(expected))
        return Refusal{415, fmt::format("The body must be {}.", expected)};
    return std::nullopt;
}

}  // namespace

bool is_loopback(std::string_view host) {
    return host == "localhost" || host == "::1" || host.starts_with("127.");
}

bool same_secret(std::string_view given, std::string_view expected) {
    unsigned char difference = given.size() == expected.size() ? 0 : 1;
    for (std::size_t k = 0; k < expected.size(); ++k)
        difference |= static_cast<unsigned char>(expected[k] ^ (k < given.size() ? given[k] : '\0'));
    return difference == 0;
}

std::string token_of_cookie(std::string_view cookie) {
    while (!cookie.empty()) {
        const std::size_t end = std::min(cookie.find(';'), cookie.size());
        std::string_view pair = cookie.substr(0, end);
        cookie.remove_prefix(std::min(end + 1, cookie.size()));
        while (pair.starts_with(' ')) pair.remove_prefix(1);
        if (pair.starts_with(cookie_name)) return std::string(pair.substr(cookie_name.size()));
    }
    return "";
}

std::optional<Refusal> refuse(const RequestHead& request, const Access& access) {
    if (!host_is_ours(request, access))
        return Refusal{
            403, fmt::format("This service is http://127.0.0.1:{}, not '{}'.", access.port, request.host)};
    if (!origin_is_ours(request)) return Refusal{403, "Pages of other sites may not use this service."};
    if (!has_token(request, access))
        return Refusal{
            401,
            "The token is missing or wrong: open the address that `capstan serve` printed, or send "
            "the header 'Authorization: Bearer TOKEN'."};
    return refuse_body(request);
}

}  // namespace capstan::service
