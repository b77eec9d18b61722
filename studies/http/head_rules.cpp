#include "capstan/http/head_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace capstan::http {

namespace {

// Two readers of a request must not choose different ones.
constexpr std::array<std::string_view, 9> single_fields{
    "host",           "content-length", "content-type", "content-encoding", "transfer-encoding", "origin",
    "sec-fetch-site", "authorization",  "expect"};

}  // namespace

std::optional<HeadProblem> problem_of(const Request& head, const ServerLimits& limits) {
    if (head.headers.size() > limits.head_fields)
        return HeadProblem{431, fmt::format("The request has {} header fields; at most {} are accepted.",
                                            head.headers.size(), limits.head_fields)};
    for (const std::string_view name : single_fields) {
        if (head.count(name) > 1)
            return HeadProblem{400, fmt::format("The header field {} may be sent only once.", name)};
    }
    if (head.count("transfer-encoding") > 0)
        return HeadProblem{411, "The body needs a Content-Length; a Transfer-Encoding is not accepted."};
    const std::string encoding = lower_case(head.header("content-encoding"));
    if (!encoding.empty() && encoding != "identity")
        return HeadProblem{415, "The body must not be compressed (Content-Encoding)."};
    if (head.content_length.value_or(0) > limits.body_bytes)
        return HeadProblem{413, fmt::format("The body has {} bytes; at most {} are accepted.",
                                            *head.content_length, limits.body_bytes)};
    const std::string expected = lower_case(head.header("expect"));
    if (!expected.empty() && expected != "100-continue")
        return HeadProblem{417, "Of the field Expect only 100-continue is known."};
    return std::nullopt;
}

// "gzip", "gzip;q=0.5" and "*", but not "gzip;q=0".
bool accepts_gzip(const Request& head) {
    std::string accepted;  // a field that is repeated is one list
    for (const auto& [name, value] : head.headers)
        if (name == "accept-encoding") accepted += lower_case(value) + ",";
    std::string_view rest = accepted;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(','), rest.size());
        std::string_view coding = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        while (coding.starts_with(' ')) coding.remove_prefix(1);
        const std::string_view name = coding.substr(0, coding.find_first_of("; "));
        if (name != "gzip" && name != "*") continue;
        const std::size_t quality = coding.find("q=0");
        return quality == std::string_view::npos ||
               coding.find_first_of("123456789", quality + 3) != std::string_view::npos;
    }
    return false;
}

}  // namespace capstan::http
