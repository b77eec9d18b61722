#include "capstan/sensing/layout.h"

#include <algorithm>

namespace capstan {

namespace {

std::string with_count(std::string_view text, int count) {
    return std::string(text) + ", " + std::to_string(count) + (count == 1 ? " sensor" : " sensors");
}

Layout sorted_layout(std::string family, std::string start, std::string label, std::vector<int> nodes) {
    std::sort(nodes.begin(), nodes.end());
    return {std::move(family), std::move(start), std::move(label), std::move(nodes)};
}

// Both variants where they differ, one without a start where they do not.
std::vector<Layout> distinct(Layout proximal, Layout distal, std::string_view title) {
    if (proximal.nodes != distal.nodes) return {std::move(proximal), std::move(distal)};
    proximal.start.clear();
    proximal.label = with_count(title, static_cast<int>(proximal.nodes.size()));
    return {std::move(proximal)};
}

// One sensor each p nodes, p as large as fits, from either end.
std::vector<Layout> even(int count, int nodes) {
    const int spacing = count > 1 ? (nodes - 1) / (count - 1) : 1;
    std::vector<int> from_proximal;
    std::vector<int> from_distal;
    for (int k = 0; k < count; ++k) {
        from_proximal.push_back(k * spacing);
        from_distal.push_back(nodes - 1 - k * spacing);
    }
    return distinct(
        sorted_layout("even", "proximal", with_count("Even from the proximal end", count), from_proximal),
        sorted_layout("even", "distal", with_count("Even from the distal end", count), from_distal), "Even");
}

std::vector<Layout> distal(int count, int nodes) {
    std::vector<int> last;
    for (int k = 0; k < count; ++k) last.push_back(nodes - 1 - k);
    return {sorted_layout("distal", "", with_count("Distal", count), last)};
}

std::vector<int> at_both_ends(int at_proximal, int count, int nodes) {
    std::vector<int> placed;
    for (int k = 0; k < at_proximal; ++k) placed.push_back(k);
    for (int k = 0; k < count - at_proximal; ++k) placed.push_back(nodes - 1 - k);
    return placed;
}

// Half at each end; the odd one at either.
std::vector<Layout> both(int count, int nodes) {
    return distinct(sorted_layout("both", "proximal", with_count("Both, the odd one proximal", count),
                                  at_both_ends((count + 1) / 2, count, nodes)),
                    sorted_layout("both", "distal", with_count("Both, the odd one distal", count),
                                  at_both_ends(count / 2, count, nodes)),
                    "Both");
}

}  // namespace

const std::vector<LayoutFamily>& layout_families() {
    static const std::vector<LayoutFamily> families = {
        {"even", "Even", "evenly spaced along the cable, from the proximal or the distal end", even},
        {"distal", "Distal", "at the distal end, node by node", distal},
        {"both", "Both", "half at the proximal end, half at the distal end, node by node", both},
    };
    return families;
}

const LayoutFamily* find_layout_family(std::string_view name) {
    for (const LayoutFamily& family : layout_families()) {
        if (family.name == name) return &family;
    }
    return nullptr;
}

Layout explicit_layout(std::vector<int> nodes) {
    std::sort(nodes.begin(), nodes.end());
    const std::string label = "Nodes " + nodes_as_people_count(nodes);
    return {"explicit", "", label, std::move(nodes)};
}

std::string nodes_as_people_count(const std::vector<int>& nodes) {
    std::string text;
    for (const int node : nodes) text += (text.empty() ? "" : ", ") + std::to_string(node + 1);
    return text;
}

}  // namespace capstan
