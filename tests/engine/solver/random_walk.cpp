#include "random_walk.h"

#include <algorithm>

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

}  // namespace capstan::test
