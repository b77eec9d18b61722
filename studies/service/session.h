#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace capstan::service {

inline constexpr std::int64_t session_s = 7 * 24 * 3600;  // a browser opens the printed address again after

/// The cookie of a browser that has shown the token: when it ends, and a signature (HMAC-SHA256) over that
/// and the port, by a key that is made from the token. The token itself is not in it, and another service on
/// the same host, to which a browser sends the cookie too, cannot use it.
class Sessions {
  public:
    Sessions(std::string_view token, int port);

    std::string cookie_name() const { return "capstan_session_" + std::to_string(port_); }
    /// The value of a new cookie. `now_s`: seconds since 1970.
    std::string begin(std::int64_t now_s) const;
    /// Whether the header Cookie carries one of ours that has not ended.
    bool is_valid(std::string_view cookie_header, std::int64_t now_s) const;

  private:
    std::string signature_of(std::string_view end) const;

    std::string key_;
    int port_;
};

/// Compares in a time that does not tell where two secrets differ.
bool same_secret(std::string_view given, std::string_view expected);

}  // namespace capstan::service
