#include "capstan/platform/wrapped_text.h"

#include <algorithm>

namespace capstan {

std::size_t columns_of(std::string_view text) {
    return std::count_if(text.begin(), text.end(), [](unsigned char c) { return (c & 0xc0) != 0x80; });
}

std::string padded(const std::string& text, std::size_t width, bool to_the_right) {
    const std::string blanks(width - std::min(width, columns_of(text)), ' ');
    return to_the_right ? blanks + text : text + blanks;
}

std::string counted(std::size_t count, const std::string& thing) {
    return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

std::string wrapped(std::string_view text, std::size_t width, std::string_view first,
                    std::string_view indent) {
    std::string result(first);
    std::size_t column = columns_of(first);
    bool line_is_empty = true;
    while (!text.empty()) {
        const std::string_view word = text.substr(0, text.find(' '));
        text.remove_prefix(std::min(text.size(), word.size() + 1));
        if (word.empty()) continue;
        if (!line_is_empty && column + 1 + columns_of(word) > width) {
            result += "\n";
            result += indent;
            column = columns_of(indent);
            line_is_empty = true;
        }
        if (!line_is_empty) {
            result += ' ';
            ++column;
        }
        result += word;
        column += columns_of(word);
        line_is_empty = false;
    }
    return result;
}

}  // namespace capstan
