#include "capstan/http/request.h"

#include <algorithm>
#include <cctype>

namespace capstan::http {

std::string_view Request::header(std::string_view name) const {
    const auto found = std::ranges::find_if(headers, [&](const auto& each) { return each.first == name; });
    return found == headers.end() ? std::string_view() : std::string_view(found->second);
}

std::size_t Request::count(std::string_view name) const {
    return static_cast<std::size_t>(
        std::ranges::count_if(headers, [&](const auto& each) { return each.first == name; }));
}

const FormPart* Request::part(std::string_view name) const {
    const auto found = std::ranges::find_if(parts, [&](const FormPart& each) { return each.name == name; });
    return found == parts.end() ? nullptr : &*found;
}

std::string lower_case(std::string_view text) {
    std::string small(text);
    std::ranges::transform(small, small.begin(), [](unsigned char c) { return std::tolower(c); });
    return small;
}

}  // namespace capstan::http
