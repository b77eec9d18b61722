#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace capstan::http {

/// A part of a form (multipart/form-data).
struct FormPart {
    std::string name;
    std::string filename;      ///< empty if it is not a file
    std::string_view content;  ///< in the body of the request
};

/// One request. Until a handler gets it, `body`, `parts` and `path_values` are empty.
struct Request {
    std::string method;                                        ///< as "GET"
    std::string path;                                          ///< decoded, without the query
    std::map<std::string, std::string> parameters;             ///< of the query, decoded
    std::vector<std::pair<std::string, std::string>> headers;  ///< names in lower case
    std::string client;                                        ///< its address
    std::optional<std::size_t> content_length;
    std::vector<std::string> path_values;  ///< what stands for the braces of the route, in their order
    std::string body;
    std::vector<FormPart> parts;

    /// The first header of this name (in lower case); empty if it is missing.
    std::string_view header(std::string_view name) const;
    std::size_t count(std::string_view name) const;

    /// The first part of this name; null if it is missing.
    const FormPart* part(std::string_view name) const;
};

/// Names and fixed words of HTTP are the same in both cases.
std::string lower_case(std::string_view text);

}  // namespace capstan::http
