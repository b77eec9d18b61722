#include "promises.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "walk.h"

namespace capstan::fuzz {

namespace {

void require(bool kept, const std::string& promise) {
    if (!kept) throw BrokenPromise(promise);
}

std::string at_node(std::size_t node) {
    return " at node " + std::to_string(node);
}

double largest(const std::vector<double>& values) {
    double most = 0.0;
    for (const double value : values) most = std::max(most, std::abs(value));
    return most;
}

}  // namespace

void demand_a_state(const Cable& cable, const CableState& state) {
    const auto nodes = static_cast<std::size_t>(cable.nodes());
    require(state.tension_N.size() == nodes && state.displacement_m.size() == nodes, "number of nodes");
    for (std::size_t node = 0; node < nodes; ++node) {
        require(std::isfinite(state.tension_N[node]), "tension is finite" + at_node(node));
        require(state.tension_N[node] >= 0.0, "tension is not negative" + at_node(node));
        require(std::isfinite(state.displacement_m[node]), "displacement is finite" + at_node(node));
    }
}

void VerifiedAnswers::demand_of(const StepReport& report, const CableState& state,
                                const EndConditions& ends) {
    largest_tension_N_ = std::max(largest_tension_N_, largest(state.tension_N));
    largest_displacement_m_ = std::max(largest_displacement_m_, largest(state.displacement_m));
    const double compliance_m_per_N = step_.cable().mean_segment_compliance_m_per_N();
    rounding_N_ = 1e-12 * (largest_tension_N_ + largest_displacement_m_ / compliance_m_per_N);
    rounding_m_ = rounding_N_ * compliance_m_per_N;
    const bool slack = report.pattern.kind == MotionKind::slack;
    unbroken_ = report.verified && (unbroken_ || slack);
    if (!unbroken_ || slack) return;
    demand_ends(state, ends);
    demand_segments(state);
}

void VerifiedAnswers::demand_ends(const CableState& state, const EndConditions& ends) const {
    const auto check = [&](const char* name, const EndCondition& end, double tension_N,
                           double displacement_m) {
        const double left = end.displacement_factor * displacement_m + end.tension_factor * tension_N;
        const double tolerance = 1e-11 * std::abs(end.value) +
                                 std::abs(end.displacement_factor) * rounding_m_ +
                                 std::abs(end.tension_factor) * rounding_N_;
        require(std::abs(left - end.value) <= tolerance, std::string(name) + " end's condition is met");
    };
    check("proximal", ends.proximal, state.tension_N.front(), state.displacement_m.front());
    check("distal", ends.distal, state.tension_N.back(), state.displacement_m.back());
}

void VerifiedAnswers::demand_segments(const CableState& state) const {
    const Cable& cable = step_.cable();
    for (int i = 0; i < cable.segments(); ++i) {
        const double a_N = state.tension_N[i];
        const double b_N = state.tension_N[i + 1];
        const double holds = std::exp(cable.static_friction() * cable.wrap_angle_rad()[i]) * (1.0 + 1e-9);
        require(std::max(a_N, b_N) <= std::min(a_N, b_N) * holds + rounding_N_,
                "a segment holds no more than static friction" + at_node(static_cast<std::size_t>(i)));
        if (step_.rules().elongation != ElongationRule::mean_tension) continue;
        const double elongation_m = state.displacement_m[i + 1] - state.displacement_m[i];
        const double expected_m = cable.segment_compliance_m_per_N(i) * 0.5 * (a_N + b_N);
        require(std::abs(elongation_m - expected_m) <= 4.0 * rounding_m_,
                "a taut segment is as long as its tensions say" + at_node(static_cast<std::size_t>(i)));
    }
}

void demand_unchanged(const CableState& before, const CableState& after) {
    require(before.tension_N == after.tension_N && before.displacement_m == after.displacement_m &&
                before.last_motion == after.last_motion,
            "a refused input leaves the state unchanged");
}

void demand_words(const std::string& thrown, const std::string& words) {
    require(thrown.find(words) != std::string::npos,
            "refused by name: expected \"" + words + "\", got \"" + thrown + "\"");
}

}  // namespace capstan::fuzz
