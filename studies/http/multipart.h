#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "capstan/http/request.h"

namespace capstan::http {

/// The parts of a body of multipart/form-data (RFC 7578), as views of it; nothing if it is damaged or has
/// more than `max_form_parts`. `content_type` is that of the request, which states the boundary.
std::optional<std::vector<FormPart>> parse_form(std::string_view content_type, std::string_view body);

inline constexpr std::size_t max_form_parts = 64;

}  // namespace capstan::http
