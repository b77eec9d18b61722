#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "capstan/http/kept_text.h"
#include "capstan/http/request.h"

namespace capstan::http {

/// The answer to a request. Its length, and what every answer has, are added when it is sent.
struct Response {
    int status = 200;
    std::vector<std::pair<std::string, std::string>> headers;
    std::string content_type;
    std::shared_ptr<const KeptText> text;  ///< null: no body
    bool is_kept = false;  ///< the text is sent again, so that compressing it is worth the time

    bool has_header(std::string_view name) const {
        return std::ranges::any_of(headers, [&](const auto& each) { return each.first == name; });
    }
    void add_header(std::string name, std::string value) {
        headers.emplace_back(std::move(name), std::move(value));
    }
};

using Handler = std::function<void(const Request&, Response&)>;

}  // namespace capstan::http
