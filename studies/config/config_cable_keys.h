#pragma once
// What both kinds of configuration say of a cable, in the same words.

#include "capstan/cable/conduit.h"
#include "capstan/config/config_key_makers.h"
#include "capstan/config/config_problem.h"

namespace capstan::config {

/// Where the kinds differ.
struct CableText {
    std::int64_t default_segments = 0;
    double default_pretension_N = 0.0;
    std::string segments_help;
};

/// The paper's static friction belongs to its dynamic friction: beside another one, static friction that
/// section `at` leaves out is the same as dynamic friction.
inline void complete_static_friction(CableSpecification& cable, const std::string& at,
                                     const KeyLines& lines) {
    if (lines.contains(at + ".dynamic_friction") && !lines.contains(at + ".static_friction"))
        cable.static_friction = cable.dynamic_friction;
}

/// Keys of section `at` and of its repeated section `at`.curvature; `cable(plan)` refers to the
/// specification.
template <class Plan, class CableOf>
void add_cable_keys(std::vector<ConfigKey<Plan>>& keys, const std::string& at, const CableText& text,
                    CableOf cable) {
    const auto add = [&](KeyText about, Limits limits, double default_value,
                         double CableSpecification::*field) {
        keys.push_back(number<Plan>(
            std::move(about), limits, default_value,
            [ cable, field ](auto& plan, int) -> auto& { return cable(plan).*field; }));
    };
    keys.push_back(integer<Plan>(
        {at, "segments", "", text.segments_help}, {1, true, 10000},
        text.default_segments, [cable](auto& plan, int) -> auto& { return cable(plan).segments; }));
    add({at, "axial_stiffness_N", "N",
         "Axial stiffness EA: force per unit strain, not per elongation. The paper's Table I says \"2 "
         "kN/m\" for its 2 m cable; used directly as EA = 2000 N it reproduces the paper's figures "
         "best."},
        above_zero, 2000.0, &CableSpecification::axial_stiffness_N);
    add({at, "dynamic_friction", "", "Friction coefficient of a segment that slides."}, zero_or_more, 0.21,
        &CableSpecification::dynamic_friction);
    add({at, "static_friction", "",
         "Friction coefficient of a segment about to slide; at least dynamic_friction. Left out where "
         "dynamic_friction is stated: the same as that."},
        zero_or_more, 0.63, &CableSpecification::static_friction);
    add({at, "pretension_N", "N", "Tension of the complete cable before the motion starts."}, zero_or_more,
        text.default_pretension_N, &CableSpecification::pretension_N);

    const std::string pieces = at + ".curvature";
    keys.push_back(number<Plan>(
        {pieces, "length_m", "m", "Length of conduit along its axis; or give angle_deg."}, above_zero,
        {}, [cable](auto& plan, int row) -> auto& { return cable(plan).curvature[row].length_m; }));
    ConfigKey<Plan> radius = number<Plan>(
        {pieces, "bend_radius_m", "m", "Bend radius of the piece; leave it out for a straight piece."},
        above_zero,
        {}, [cable](auto& plan, int row) -> auto& { return cable(plan).curvature[row].bend_radius_m; });
    radius.read = [cable](const Plan& plan, int row) -> ConfigValue {
        const double radius_m = cable(plan).curvature[row].bend_radius_m;
        return radius_m == straight ? ConfigValue{} : ConfigValue{radius_m};
    };
    keys.push_back(std::move(radius));
    auto angle = unbound_key<Plan>(
        {pieces, "angle_deg", "degrees",
         "By how much the piece turns, in place of its length, which is angle times radius."},
        ValueKind::number, {0.0, false, 3600.0}, {});
    angle.condition = {[cable](const Plan& plan, int row) {
                           const CurvaturePiece& piece = cable(plan).curvature[row];
                           return piece.length_m == 0.0 && piece.bend_radius_m < straight;
                       },
                       "bend_radius_m and without length_m"};
    angle.read = [](const Plan&, int) { return ConfigValue{}; };
    angle.write = [cable](Plan& plan, int row, const ConfigValue& value) {
        CurvaturePiece& piece = cable(plan).curvature[row];
        piece.length_m = std::get<double>(value) * rad_per_degree * piece.bend_radius_m;
    };
    keys.push_back(std::move(angle));
}

/// The repeated section of the conduit's pieces. `CableOf{}(plan)` refers to a plan's specification.
template <class Plan, class CableOf>
ConfigSection<Plan> curvature_section(const std::string& path, CableOf, void (*fill_default)(Plan&)) {
    return {path, "The course of the conduit from the proximal end, as pieces with one bend radius each.",
            [](const Plan& plan) { return static_cast<int>(CableOf{}(plan).curvature.size()); },
            [](Plan& plan, int count) { CableOf{}(plan).curvature.assign(count, {}); }, fill_default};
}

}  // namespace capstan::config
