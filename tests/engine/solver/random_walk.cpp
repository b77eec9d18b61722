#include "random_walk.h"

#include <algorithm>
#include <cmath>

namespace capstan::test {

namespace {

constexpr double spring_N_per_m = 500.0;
constexpr double min_prescribed_tension_N = 0.5;
constexpr double drift_fraction = 0.6;  // of a step; the rest is new in every step
constexpr double longest_way = 20.0;    // steps

}  // namespace

EndTarget RandomWalk::moved(EndTarget target, EndKind kind, Way& way) {
    if (way.steps_left-- <= 0) way = {draw(), static_cast<int>(longest_way * (1.0 + draw()))};
    const auto fraction = [&] { return drift_fraction * way.drift + (1.0 - drift_fraction) * draw(); };
    target.displacement_m += step_m_ * fraction();
    if (kind != EndKind::position) target.tension_N += step_m_ * stiffness_N_per_m_ * fraction();
    if (kind == EndKind::tension) target.tension_N = std::max(target.tension_N, min_prescribed_tension_N);
    return target;
}

EndConditions RandomWalk::next(const CableState& state) {
    const EndTarget proximal = moved(proximal_end(state), pair_.proximal, proximal_);
    const EndTarget distal = moved(distal_end(state), pair_.distal, distal_);
    return ends_of(pair_, proximal, distal, spring_N_per_m);
}

bool moderately_stretched(const CableState& state) {
    const double stretch_m = state.displacement_m.back() - state.displacement_m.front();
    return stretch_m >= 2e-3 && stretch_m <= 40e-3;
}

CableState random_state(const QuasiStaticStep& step, unsigned seed) {
    constexpr double throw_m = 3e-3;
    RandomWalk walk(step.cable(), {EndKind::position, EndKind::position}, throw_m, seed);
    CableState state = pretensioned(step.cable());
    for (int k = 0; k < 8; ++k) {
        CableState next = state;
        step.advance(next, walk.next(state));
        if (moderately_stretched(next)) state = next;
    }
    return state;
}

void unsettle(CableState& state, const PrefixTables& tables, std::mt19937_64& random) {
    const double spread = std::pow(10.0, std::uniform_real_distribution<double>(-3.0, -0.2)(random));
    std::uniform_real_distribution<double> change(-spread, spread);
    for (double& tension_N : state.tension_N) tension_N *= std::exp(change(random));
    for (std::size_t node = 1; node < state.tension_N.size(); ++node)
        state.displacement_m[node] =
            state.displacement_m[node - 1] +
            tables.half_compliance_m_per_N[node - 1] * (state.tension_N[node - 1] + state.tension_N[node]);
}

double random_size(double lowest_exponent, double highest_exponent, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const double exponent =
        lowest_exponent + 0.5 * (1.0 + uniform(random)) * (highest_exponent - lowest_exponent);
    const double size = std::pow(10.0, exponent);
    const double chance = uniform(random);
    return chance < -0.8 ? 0.0 : chance < 0.1 ? -size : size;
}

}  // namespace capstan::test
