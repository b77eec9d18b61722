#pragma once

#include <string>
#include <string_view>

namespace capstan {

/// Breaks a text at blanks into lines of at most `width` columns (bytes beyond ASCII count as one per
/// character); each line begins with `indent`, the first one with `first` instead. Ends without a line break.
std::string wrapped(std::string_view text, std::size_t width, std::string_view first,
                    std::string_view indent);

/// Columns that a UTF-8 text takes.
std::size_t columns_of(std::string_view text);

/// Filled up with blanks to `width` columns, on its left if it belongs to the right.
std::string padded(const std::string& text, std::size_t width, bool to_the_right);

/// "2 sensors", "1 sensor".
std::string counted(std::size_t count, const std::string& thing);

}  // namespace capstan
