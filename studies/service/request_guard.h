#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace capstan::service {

/// Which requests the service accepts.
struct Access {
    std::string host = "127.0.0.1";  ///< as it was told to bind to
    int port = 0;
    std::string token;  ///< every request must show it; empty: none needed, on loopback only
};

/// The part of a request that is known before its body is read. A missing header is empty.
struct RequestHead {
    std::string method;
    std::string path;
    std::string host;
    std::string origin;
    std::string fetch_site;  ///< Sec-Fetch-Site
    std::string content_type;
    std::string transfer_encoding;
    std::optional<std::size_t> content_length;
};

struct Refusal {
    int status = 400;  ///< of HTTP
    std::string message;
};

/// Whether an address is a loopback address.
bool is_loopback(std::string_view host);

inline constexpr std::size_t largest_upload_bytes = 64 << 20;  // an hour of a bench at 1 kHz as CSV
inline constexpr std::size_t largest_text_bytes = 1 << 20;     // a configuration, a query

/// Why a request is rejected, whatever token it shows; nothing if it is accepted.
///
/// A page of another site must not reach a service on the reader's own machine: neither by a name that was
/// made to point here (Host), nor by a script or form of its own (Origin, Sec-Fetch-Site, content type).
/// Without a length a body could have any size.
std::optional<Refusal> refuse_origin(const RequestHead& request, const Access& access);
std::optional<Refusal> refuse_body(const RequestHead& request);

}  // namespace capstan::service
