#include "capstan/service/session.h"

#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>

#include <algorithm>
#include <stdexcept>

#include "capstan/platform/parsed_number.h"

namespace capstan::service {

namespace {

constexpr std::string_view purpose = "capstan serve, session of a browser";

std::string hmac_of(std::string_view key, std::string_view text) {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int size = 0;
    if (::HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
               reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest, &size) == nullptr)
        throw std::runtime_error("a session cannot be signed");
    return {reinterpret_cast<const char*>(digest), size};
}

std::string cookie_named(std::string_view name, std::string_view cookies) {
    while (!cookies.empty()) {
        const std::size_t end = std::min(cookies.find(';'), cookies.size());
        std::string_view pair = cookies.substr(0, end);
        cookies.remove_prefix(std::min(end + 1, cookies.size()));
        while (pair.starts_with(' ')) pair.remove_prefix(1);
        if (pair.starts_with(name) && pair.substr(name.size()).starts_with('='))
            return std::string(pair.substr(name.size() + 1));
    }
    return "";
}

}  // namespace

Sessions::Sessions(std::string_view token, int port) : key_(hmac_of(token, purpose)), port_(port) {}

std::string Sessions::signature_of(std::string_view end) const {
    std::string hex;
    for (const char byte : hmac_of(key_, fmt::format("{} {}", port_, end)))
        hex += fmt::format("{:02x}", static_cast<unsigned char>(byte));
    return hex;
}

std::string Sessions::begin(std::int64_t now_s) const {
    const std::string end = std::to_string(now_s + session_s);
    return end + "." + signature_of(end);
}

bool Sessions::is_valid(std::string_view cookie_header, std::int64_t now_s) const {
    const std::string cookie = cookie_named(cookie_name(), cookie_header);
    const std::size_t dot = cookie.find('.');
    if (dot == std::string::npos) return false;
    const std::string end = cookie.substr(0, dot);
    const auto end_s = parsed_number<std::int64_t>(end);
    return end_s && same_secret(cookie.substr(dot + 1), signature_of(end)) && now_s < *end_s;
}

bool same_secret(std::string_view given, std::string_view expected) {
    unsigned char difference = given.size() == expected.size() ? 0 : 1;
    for (std::size_t k = 0; k < expected.size(); ++k)
        difference |= static_cast<unsigned char>(expected[k] ^ (k < given.size() ? given[k] : '\0'));
    return difference == 0;
}

}  // namespace capstan::service
