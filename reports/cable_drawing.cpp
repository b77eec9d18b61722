#include "capstan/reports/cable_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "capstan/reports/html_text.h"

namespace capstan::reports {
namespace {

// In the units of the drawing, which scales with the page.
constexpr double width = 760, height = 142;
constexpr double cable_left = 66, cable_right = 694, cable_y = 66;
constexpr double pin_y = 22, pin_radius = 12;
constexpr double narrowest_label = 54;

struct Bend {  // neighbouring segments of one radius
    double start_m = 0;
    double end_m = 0;
    std::optional<double> radius_m;  // nothing: straight
    double wrap_angle_rad = 0;
};

// Segments cut from one bend have its radius up to rounding.
bool same_bend(std::optional<double> a_m, std::optional<double> b_m) {
    if (!a_m || !b_m) return !a_m && !b_m;
    return std::abs(*a_m - *b_m) <= 1e-9 * std::abs(*a_m);
}

std::vector<Bend> bends(const Table& segments) {
    std::vector<Bend> list;
    for (const Row& segment : segments.each()) {
        const auto radius_m = segment.maybe_number("bend_radius_m");
        const double start_m = segment.number("start_m");
        if (list.empty() || !same_bend(list.back().radius_m, radius_m))
            list.push_back({start_m, start_m, radius_m, 0});
        list.back().end_m = start_m + segment.number("length_m");
        list.back().wrap_angle_rad += segment.number("wrap_angle_rad");
    }
    return list;
}

std::string bend_label(const Bend& bend, double drawn_width) {
    if (drawn_width < narrowest_label) return "";
    if (!bend.radius_m) return "straight";
    constexpr double degrees_per_rad = 57.29577951308232;
    const std::string radius = *bend.radius_m < 0.1 ? fmt::format("R {:.0f} mm", 1000 * *bend.radius_m)
                                                    : fmt::format("R {:.3g} m", *bend.radius_m);
    const std::string wrap = fmt::format("{:.0f}°", degrees_per_rad * std::abs(bend.wrap_angle_rad));
    return drawn_width < 2 * narrowest_label ? wrap : radius + ", wraps " + wrap;
}

std::string draw_end(double x, const char* name, const char* end) {
    return fmt::format(
        R"(<rect class="end" x="{:.1f}" y="{:.1f}" width="44" height="30" rx="6"/><text class="end-name" x="{:.1f}" y="{:.1f}">{}</text><text class="note" x="{:.1f}" y="{:.1f}">{}</text>)",
        x - 22, cable_y - 15, x, cable_y + 4, name, x, cable_y + 33, end);
}

}  // namespace

std::vector<double> node_positions_m(const Table& segments) {
    std::vector<double> positions;
    for (const Row& segment : segments.each()) {
        if (positions.empty()) positions.push_back(segment.number("start_m"));
        positions.push_back(segment.number("start_m") + segment.number("length_m"));
    }
    return positions;
}

std::string cable_drawing(const Table& segments, const std::vector<int>& sensor_nodes) {
    const std::vector<double> nodes_m = node_positions_m(segments);
    if (nodes_m.size() < 2) return "";
    const double length_m = nodes_m.back() - nodes_m.front();
    const auto x_of = [&](double arc_m) {
        return cable_left + (cable_right - cable_left) * (arc_m - nodes_m.front()) / length_m;
    };
    const std::vector<Bend> runs = bends(segments);
    double sharpest_per_m = 0;
    for (const Bend& bend : runs) {
        if (bend.radius_m) sharpest_per_m = std::max(sharpest_per_m, 1 / *bend.radius_m);
    }

    std::string list_of_nodes;
    for (const int node : sensor_nodes)
        list_of_nodes += (list_of_nodes.empty() ? "" : ", ") + std::to_string(node);
    std::string svg = fmt::format(
        R"(<svg class="cable" viewBox="0 0 {:.0f} {:.0f}" role="img" aria-label="Cable of {} from motor to load, {} nodes, sensors at nodes {}">)",
        width, height, escape_html(fmt::format("{:.3g} m", length_m)), nodes_m.size(), list_of_nodes);

    svg += fmt::format(R"(<line class="conduit" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)",
                       cable_left, cable_y, cable_right, cable_y);
    for (const Bend& bend : runs) {
        const double left = x_of(bend.start_m), right = x_of(bend.end_m);
        if (bend.radius_m) {
            const double sharpness = 1 / *bend.radius_m / sharpest_per_m;  // ratio to the sharpest bend
            svg += fmt::format(
                R"(<rect class="bend" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="18" fill-opacity="{:.2f}"><title>bend radius {:.3g} m, wrap angle {:.3g} rad</title></rect>)",
                left, cable_y - 9, right - left, 0.12 + 0.3 * sharpness, *bend.radius_m, bend.wrap_angle_rad);
        }
        const std::string label = bend_label(bend, right - left);
        if (label.empty()) continue;
        svg += fmt::format(
            R"(<path class="bracket" d="M{0:.1f} {2:.1f}v5H{1:.1f}v-5"/><text class="note" x="{3:.1f}" y="{4:.1f}">{5}</text>)",
            left + 3, right - 3, cable_y + 16, (left + right) / 2, cable_y + 38, escape_html(label));
    }
    svg += fmt::format(R"(<line class="core" x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}"/>)", cable_left,
                       cable_y, cable_right, cable_y);
    for (const double arc_m : nodes_m) {
        svg += fmt::format(R"(<circle class="node" cx="{:.1f}" cy="{:.1f}" r="3"/>)", x_of(arc_m), cable_y);
    }
    svg += draw_end(cable_left - 34, "motor", "proximal") + draw_end(cable_right + 34, "load", "distal");

    const bool roomy =
        (cable_right - cable_left) / static_cast<double>(nodes_m.size() - 1) > 2 * pin_radius + 2;
    for (const int node : sensor_nodes) {
        if (node < 1 || node > static_cast<int>(nodes_m.size())) continue;
        const double x = x_of(nodes_m[static_cast<std::size_t>(node - 1)]);
        svg += fmt::format(
            R"(<g class="sensor"><title>sensor at node {0}, {1:.3g} m from the motor</title><line x1="{2:.1f}" y1="{3:.1f}" x2="{2:.1f}" y2="{4:.1f}"/><circle cx="{2:.1f}" cy="{3:.1f}" r="{5:.1f}"/>)",
            node, nodes_m[static_cast<std::size_t>(node - 1)], x, pin_y, cable_y, roomy ? pin_radius : 3.0);
        if (roomy) svg += fmt::format(R"(<text x="{:.1f}" y="{:.1f}">{}</text>)", x, pin_y + 4.5, node);
        svg += "</g>";
    }

    const double scale_y = height - 8;
    const int ticks = 5;
    for (int tick = 0; tick <= ticks; ++tick) {
        const double arc_m = nodes_m.front() + length_m * tick / ticks;
        svg += fmt::format(R"(<text class="tick" x="{:.1f}" y="{:.1f}">{:.3g}{}</text>)", x_of(arc_m),
                           scale_y, arc_m, tick == ticks ? " m" : "");
    }
    return svg + "</svg>\n";
}

}  // namespace capstan::reports
