#include "capstan/solver/prefix_tables.h"

#include <cmath>

namespace capstan {

double sliding_elongation_m_per_N(ElongationRule rule, double compliance_m_per_N, double exponent) {
    switch (rule) {
        case ElongationRule::mean_tension:
            return compliance_m_per_N * 0.5 * (1.0 + std::exp(exponent));
        case ElongationRule::exponential_and_mean:
            return exponent == 0.0 ? compliance_m_per_N
                                   : compliance_m_per_N * std::expm1(exponent) / exponent;  // E2
    }
    return 0.0;
}

namespace {

// `outward` walks away from the end: the exponent of each segment as met on the way.
SideTable side_table(const Cable& cable, const ModelRules& rules, int direction_sign, bool from_proximal) {
    const int nodes = cable.nodes();
    SideTable table;
    table.tension_ratio.resize(nodes);
    table.elongation_m_per_N.resize(nodes);
    table.front_compliance_m_per_N.resize(nodes);

    double exponent_sum = 0.0;
    double elongation = 0.0;
    for (int step = 0; step < nodes; ++step) {
        const int node = from_proximal ? step : nodes - 1 - step;
        const double ratio = std::exp(exponent_sum);
        table.tension_ratio[node] = ratio;
        table.elongation_m_per_N[node] = elongation;
        // There is no front beyond the other end.
        table.front_compliance_m_per_N[node] = elongation;
        if (step + 1 == nodes) break;
        const int segment = from_proximal ? node : node - 1;
        const double compliance = cable.segment_compliance_m_per_N(segment);
        table.front_compliance_m_per_N[node] = elongation + 0.5 * compliance * ratio;
        const double wrap_rad = cable.wrap_angle_rad()[segment];
        // Sliding forward makes tension grow towards the distal end, so it falls as seen from there (E1).
        const double exponent =
            (from_proximal ? 1 : -1) * direction_sign * cable.dynamic_friction() * wrap_rad;
        elongation += ratio * sliding_elongation_m_per_N(rules.elongation, compliance, exponent);
        exponent_sum += exponent;
    }
    return table;
}

}  // namespace

PrefixTables::PrefixTables(const Cable& cable, const ModelRules& rules)
    : relative_position(cable.relative_position().begin(), cable.relative_position().end()) {
    for (int segment = 0; segment < cable.segments(); ++segment)
        half_compliance_m_per_N.push_back(0.5 * cable.segment_compliance_m_per_N(segment));
    for (const double wrap_rad : cable.wrap_angle_rad()) {
        sliding_exponent.push_back(cable.dynamic_friction() * wrap_rad);
        sliding_ratio.push_back(std::exp(cable.dynamic_friction() * wrap_rad));
        breakaway_ratio.push_back(std::exp(cable.static_friction() * wrap_rad));
    }
    for (const int direction_sign : {-1, 1}) {
        proximal_[direction_sign > 0] = side_table(cable, rules, direction_sign, true);
        distal_[direction_sign > 0] = side_table(cable, rules, direction_sign, false);
    }
}

void PrefixTables::set_sliding_exponents(std::span<const double> exponents) {
    for (std::size_t s = 0; s < exponents.size(); ++s) {
        sliding_exponent[s] = exponents[s];
        sliding_ratio[s] = breakaway_ratio[s] = std::exp(exponents[s]);
    }
    fill_sides();
}

void PrefixTables::assign(double mean_compliance_m_per_N, const double* exponents, const double* ratios,
                          const double* breakaway_ratios, std::size_t stride) {
    const std::size_t segments = sliding_ratio.size();
    for (std::size_t s = 0; s < segments; ++s) {
        const double relative_length = relative_position[s + 1] - relative_position[s];
        half_compliance_m_per_N[s] = 0.5 * mean_compliance_m_per_N * relative_length;
        sliding_exponent[s] = exponents[s * stride];
        sliding_ratio[s] = ratios[s * stride];
        breakaway_ratio[s] = breakaway_ratios[s * stride];
    }
    fill_sides();
}

// Products in place of exponentials: within rounding of the tables made from a cable.
void PrefixTables::fill_sides() {
    const std::size_t segments = sliding_ratio.size();
    const auto fill = [&](SideTable& table, bool grows, bool from_proximal) {
        double ratio = 1.0;
        double elongation = 0.0;
        for (std::size_t step = 0; step <= segments; ++step) {
            const std::size_t node = from_proximal ? step : segments - step;
            table.tension_ratio[node] = ratio;
            table.elongation_m_per_N[node] = elongation;
            table.front_compliance_m_per_N[node] = elongation;
            if (step == segments) break;
            const std::size_t segment = from_proximal ? node : node - 1;
            const double half = half_compliance_m_per_N[segment];
            table.front_compliance_m_per_N[node] = elongation + half * ratio;
            const double across = sliding_ratio[segment];
            const double next = grows ? ratio * across : ratio / across;
            elongation += half * (ratio + next);
            ratio = next;
        }
    };
    for (const bool forward : {false, true}) {
        fill(proximal_[forward], forward, true);
        fill(distal_[forward], !forward, false);
    }
}

}  // namespace capstan
