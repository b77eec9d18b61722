#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace capstan {

/// The number that a text is; nothing where it is not a number, or more than one.
template <typename Number>
std::optional<Number> parsed_number(std::string_view text) {
    Number number{};
    const char* const end = text.data() + text.size();
    const auto [last, problem] = std::from_chars(text.data(), end, number);
    if (problem != std::errc{} || last != end) return std::nullopt;
    return number;
}

}  // namespace capstan
