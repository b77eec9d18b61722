#include "capstan/platform/nearest_name.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace capstan {

namespace {

std::string lower_case(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return result;
}

// Damerau-Levenshtein distance, neighbouring letters swapped count once (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        now[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
            const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
            if (swapped) now[j] = std::min(now[j], before_last[j - 2] + 1);
        }
        before_last.swap(last);
        last.swap(now);
    }
    return last[b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view name, std::span<const std::string> known) {
    const std::string wanted = lower_case(name);
    std::size_t best = std::max<std::size_t>(2, wanted.size() / 3) + 1;
    std::optional<std::string> nearest;
    for (const std::string& candidate : known) {
        const std::string other = lower_case(candidate);
        const bool begun = wanted.size() >= 3 && other.starts_with(wanted);
        const bool is_part = wanted.size() >= 4 && other.find(wanted) != std::string::npos;
        const std::size_t distance = begun ? 1 : is_part ? 2 : edit_distance(wanted, other);
        if (distance >= best || distance >= other.size()) continue;
        best = distance;
        nearest = candidate;
    }
    return nearest;
}

std::string suggestion(std::string_view name, std::span<const std::string> known) {
    if (const auto nearest = nearest_name(name, known)) return "; did you mean '" + *nearest + "'?";
    std::string text;
    for (const std::string& candidate : known) text += (text.empty() ? "; known are " : ", ") + candidate;
    return text;
}

}  // namespace capstan
