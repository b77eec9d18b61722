#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace capstan {

/// The known name that `name` was probably meant to be: one that it begins or is part of, or the one with the
/// fewest letters inserted, left out, exchanged or swapped, if those are few.
std::optional<std::string> nearest_name(std::string_view name, std::span<const std::string> known);

/// "; did you mean 'segments'?", or "; known are a, b, c" where nothing is near.
std::string suggestion(std::string_view name, std::span<const std::string> known);

}  // namespace capstan
