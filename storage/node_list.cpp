#include "capstan/storage/node_list.h"

#include <charconv>

#include "capstan/storage/error.h"

namespace capstan::storage {

std::string node_list_text(const std::vector<int>& nodes) {
    std::string text = "[";
    for (const int node : nodes) {
        if (text.size() > 1) text += ',';
        text += std::to_string(node);
    }
    return text + "]";
}

std::vector<int> parse_node_list(std::string_view text) {
    std::vector<int> nodes;
    const char* const end = text.data() + text.size();
    for (const char* next = text.data(); next != end;) {
        if (*next == '[' || *next == ',' || *next == ']' || *next == ' ') {
            ++next;
            continue;
        }
        int node = 0;
        const auto [after, problem] = std::from_chars(next, end, node);
        if (problem != std::errc{}) throw Error("Not a list of nodes: " + std::string(text));
        nodes.push_back(node);
        next = after;
    }
    return nodes;
}

}  // namespace capstan::storage
