#include "energy_account.h"

#include <algorithm>
#include <cmath>

namespace capstan::test {

namespace {

double mean_N(const CableState& state, int segment) {
    return 0.5 * (state.tension_N[segment] + state.tension_N[segment + 1]);
}

double stored_J(const Cable& cable, const CableState& state, int segment) {
    return 0.5 * cable.segment_compliance_m_per_N(segment) * mean_N(state, segment) * mean_N(state, segment);
}

// Elongation beyond what the tension explains: 0 of a taut segment, negative of a slack one.
double gap_m(const Cable& cable, const CableState& state, int segment) {
    return state.displacement_m[segment + 1] - state.displacement_m[segment] -
           cable.segment_compliance_m_per_N(segment) * mean_N(state, segment);
}

bool slides_on(const CableState& before, const CableState& after, int segment, int segments) {
    const Direction now = segment_direction(after.last_motion, segment, segments);
    return now != Direction::none && now == segment_direction(before.last_motion, segment, segments);
}

}  // namespace

EnergyAccount& EnergyAccount::operator+=(const EnergyAccount& step) {
    ends_J += step.ends_J;
    throughput_J += step.throughput_J;
    stored_J += step.stored_J;
    friction_J += step.friction_J;
    untaken_slack_J += step.untaken_slack_J;
    worst_sliding_J = std::min(worst_sliding_J, step.worst_sliding_J);
    return *this;
}

EnergyAccount account(const Cable& cable, const CableState& before, const CableState& after) {
    const auto middle_N = [&](int node) { return 0.5 * (before.tension_N[node] + after.tension_N[node]); };
    const auto moved_m = [&](int node) { return after.displacement_m[node] - before.displacement_m[node]; };
    const int last = cable.segments();
    const double proximal_J = -middle_N(0) * moved_m(0);
    const double distal_J = middle_N(last) * moved_m(last);
    EnergyAccount sum;
    sum.ends_J = proximal_J + distal_J;
    sum.throughput_J = std::abs(proximal_J) + std::abs(distal_J);
    for (int i = 0; i < last; ++i) {
        const double friction_J = (middle_N(i + 1) - middle_N(i)) * 0.5 * (moved_m(i) + moved_m(i + 1));
        sum.friction_J += friction_J;
        sum.stored_J += stored_J(cable, after, i) - stored_J(cable, before, i);
        sum.untaken_slack_J +=
            0.5 * (middle_N(i) + middle_N(i + 1)) * (gap_m(cable, after, i) - gap_m(cable, before, i));
        if (slides_on(before, after, i, last))
            sum.worst_sliding_J = std::min(sum.worst_sliding_J, friction_J);
    }
    return sum;
}

}  // namespace capstan::test
