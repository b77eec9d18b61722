#include "capstan/http/route_table.h"

#include <algorithm>
#include <optional>

namespace capstan::http {

namespace {

std::vector<std::string> segments_of(std::string_view path) {
    std::vector<std::string> segments;
    for (;;) {
        const std::size_t end = std::min(path.find('/'), path.size());
        segments.emplace_back(path.substr(0, end));
        if (end == path.size()) return segments;
        path.remove_prefix(end + 1);
    }
}

bool is_number(const std::string& text) {
    return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

std::optional<std::vector<std::string>> values_of(const std::vector<std::string>& pattern,
                                                  const std::vector<std::string>& given) {
    if (pattern.size() != given.size()) return std::nullopt;
    std::vector<std::string> values;
    for (std::size_t k = 0; k < pattern.size(); ++k) {
        if (!pattern[k].starts_with('{')) {
            if (pattern[k] != given[k]) return std::nullopt;
            continue;
        }
        if (pattern[k] == "{name}" ? given[k].empty() : !is_number(given[k])) return std::nullopt;
        values.push_back(given[k]);
    }
    return values;
}

}  // namespace

void RouteTable::add(std::string method, std::string_view path, Handler handler, std::size_t lane) {
    entries_.push_back({std::move(method), segments_of(path), std::move(handler), lane});
}

RouteTable::Found RouteTable::find(std::string_view method, std::string_view path) const {
    const std::vector<std::string> given = segments_of(path);
    const std::string_view wanted = method == "HEAD" ? "GET" : method;
    Found found;
    for (const Entry& entry : entries_) {
        auto values = values_of(entry.segments, given);
        if (!values) continue;
        if (entry.method == wanted) return {&entry, std::move(*values), false};
        found.other_method = true;
    }
    return found;
}

}  // namespace capstan::http
