#include "capstan/http/multipart.h"

#include <algorithm>

namespace capstan::http {

namespace {

constexpr std::size_t longest_boundary = 70;  // RFC 2046
constexpr std::size_t longest_part_head = 4096;
constexpr std::string_view line_end = "\r\n";

// name="value" or name=value among the parameters of a header, which begin with the first semicolon. In a
// quoted value \" stands for a quote; browsers write %22, which stays.
std::string parameter_of(std::string_view header, std::string_view wanted) {
    std::size_t at = header.find(';');
    while (at < header.size()) {
        at = header.find_first_not_of("; \t", at);
        if (at == std::string_view::npos) break;
        const std::size_t equals = header.find('=', at);
        if (equals == std::string_view::npos) break;
        const std::string name = lower_case(header.substr(at, equals - at));
        std::string value;
        at = equals + 1;
        if (at < header.size() && header[at] == '"') {
            for (++at; at < header.size() && header[at] != '"'; ++at) {
                if (header[at] == '\\' && at + 1 < header.size() && header[at + 1] == '"') ++at;
                value += header[at];
            }
            at = std::min(header.find(';', at), header.size());
        } else {
            const std::size_t end = std::min(header.find(';', at), header.size());
            value = header.substr(at, end - at);
            while (value.ends_with(' ')) value.pop_back();
            at = end;
        }
        if (name == wanted) return value;
    }
    return "";
}

// The lines between a boundary and the blank line; nothing without a name.
std::optional<FormPart> part_of(std::string_view head, std::string_view content) {
    while (!head.empty()) {
        const std::size_t end = std::min(head.find(line_end), head.size());
        const std::string_view line = head.substr(0, end);
        head.remove_prefix(std::min(end + line_end.size(), head.size()));
        if (!lower_case(line.substr(0, line.find(':'))).starts_with("content-disposition")) continue;
        FormPart part{parameter_of(line, "name"), parameter_of(line, "filename"), content};
        if (!part.name.empty()) return part;
    }
    return std::nullopt;
}

}  // namespace

std::optional<std::vector<FormPart>> parse_form(std::string_view content_type, std::string_view body) {
    const std::string boundary = parameter_of(content_type, "boundary");
    if (boundary.empty() || boundary.size() > longest_boundary) return std::nullopt;
    const std::string first = "--" + boundary;
    const std::string border = std::string(line_end) + first;
    if (!body.starts_with(first)) return std::nullopt;
    body.remove_prefix(first.size());
    std::vector<FormPart> parts;
    while (!body.starts_with("--")) {
        if (!body.starts_with(line_end) || parts.size() == max_form_parts) return std::nullopt;
        // A part without headers is not a part of a form, so its head ends with a blank line.
        const std::size_t blank = body.substr(0, longest_part_head).find("\r\n\r\n");
        if (blank == std::string_view::npos) return std::nullopt;
        const std::string_view head =
            body.substr(line_end.size(), std::max(blank, line_end.size()) - line_end.size());
        body.remove_prefix(blank + 4);
        const std::size_t end = body.find(border);
        if (end == std::string_view::npos) return std::nullopt;
        const auto part = part_of(head, body.substr(0, end));
        if (!part) return std::nullopt;
        parts.push_back(*part);
        body.remove_prefix(end + border.size());
    }
    return parts;
}

}  // namespace capstan::http
