#include "capstan/cluster/shell_words.h"

#include <string_view>

namespace capstan::cluster {

std::string quoted(const std::string& text) {
    std::string result = "'";
    for (const char c : text) {
        if (c == '\'')
            result += "'\\''";
        else
            result += c;
    }
    return result + "'";
}

std::string quoted_for_sbatch(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '%') result += '%';
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + "\"";
}

std::string as_typed(const std::vector<std::string>& words) {
    constexpr std::string_view plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,%+@";
    std::string text;
    for (const std::string& word : words) {
        const bool is_plain = !word.empty() && word.find_first_not_of(plain) == std::string::npos;
        text += (text.empty() ? "" : " ") + (is_plain ? word : quoted(word));
    }
    return text;
}

std::string without_line_end(std::string text) {
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
    return text;
}

}  // namespace capstan::cluster
