#include "capstan/http/target.h"

#include <algorithm>

namespace capstan::http {

namespace {

enum class Plus { stays, is_blank };  // in a path, in a query

int digit_of(char letter) {
    if (letter >= '0' && letter <= '9') return letter - '0';
    if (letter >= 'a' && letter <= 'f') return letter - 'a' + 10;
    if (letter >= 'A' && letter <= 'F') return letter - 'A' + 10;
    return -1;
}

std::optional<std::string> decoded(std::string_view text, Plus plus) {
    std::string plain;
    for (std::size_t k = 0; k < text.size(); ++k) {
        char letter = text[k];
        if (letter == '+' && plus == Plus::is_blank) letter = ' ';
        if (letter == '%') {
            const int high = k + 1 < text.size() ? digit_of(text[k + 1]) : -1;
            const int low = k + 2 < text.size() ? digit_of(text[k + 2]) : -1;
            if (high < 0 || low < 0) return std::nullopt;
            letter = static_cast<char>(high * 16 + low);
            k += 2;
        }
        if (letter == '\0') return std::nullopt;
        plain += letter;
    }
    return plain;
}

}  // namespace

std::optional<Target> parse_target(std::string_view text) {
    if (!text.starts_with('/')) return std::nullopt;
    text = text.substr(0, text.find('#'));
    const std::size_t mark = std::min(text.find('?'), text.size());
    const auto path = decoded(text.substr(0, mark), Plus::stays);
    if (!path) return std::nullopt;
    Target target{*path, {}};
    std::string_view rest = text.substr(std::min(mark + 1, text.size()));
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('&'), rest.size());
        const std::string_view pair = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        const std::size_t equals = std::min(pair.find('='), pair.size());
        const auto name = decoded(pair.substr(0, equals), Plus::is_blank);
        const auto value = decoded(pair.substr(std::min(equals + 1, pair.size())), Plus::is_blank);
        if (!name || !value) return std::nullopt;
        if (!name->empty()) target.parameters.emplace(*name, *value);
    }
    return target;
}

}  // namespace capstan::http
