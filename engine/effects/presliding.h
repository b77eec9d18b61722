#ifndef CAPSTAN_EFFECTS_PRESLIDING_H
#include "capstan/effects/effect_row.h"
#include "capstan/effects/law.h"

namespace capstan {

/// How far the bristles between cable and conduit are bent, as a fraction of full friction: -1 to 1.
template <class Number>
struct Bristle {
    Number bend;
    Number bend_per_m;  ///< slope with further sliding
};

/// Friction that builds up over a small displacement before the cable slides (E22, Dahl):
/// dz / du = (1 - z sign(du))^exponent / length, friction = z times full friction.
template <class Number>
struct PreslidingLaw {
    Number length_m = 0.0;  ///< 0: as stiff as numerics allow
    Number exponent = 1.0;  ///< 0: straight to full friction, 1: exponential approach

    bool is_active() const { return length_m != 0.0; }
    static std::vector<EffectRow<PreslidingLaw>> rows() {
        return {
            {.about = {.name = "presliding",
                       .title = "presliding",
                       .family = "friction law",
                       .component = "conduit",
                       .equation = "E22",
                       .meaning = "friction that builds up over a small displacement",
                       .changes_the_cable = true},
             .parameters = {
                 {{.name = "length", .unit = "m", .high = 0.1, .typical = 5e-4}, &PreslidingLaw::length_m},
                 {{.name = "exponent", .high = 2.0, .typical = 1.0, .role = ParameterRole::shape},
                  &PreslidingLaw::exponent}}}};
    }
};
using Presliding = PreslidingLaw<double>;

}  // namespace capstan
#endif

#if !defined(CAPSTAN_EFFECTS_PRESLIDING_H) || defined(CAPSTAN_LAWS_FOR_LANES)
#define CAPSTAN_EFFECTS_PRESLIDING_H
CAPSTAN_LAWS_BEGIN

template <class Condition, class Number>
CAPSTAN_LAW Bristle<Number> choose(Condition condition, const Bristle<Number>& a, const Bristle<Number>& b) {
    return {select(condition, a.bend, b.bend), select(condition, a.bend_per_m, b.bend_per_m)};
}

/// The bristles after further sliding; exact over a step.
template <class Number>
CAPSTAN_LAW Bristle<Number> bristle_after(const PreslidingLaw<Number>& law, Number bend, Number slid_m) {
    const Number zero = constant<Number>(0.0);
    const Number one = constant<Number>(1.0);
    // If the cable has not moved: the way that the bristles are bent.
    const Number leaning = select(is_equal(slid_m, zero), bend, slid_m);
    const Number way = select(is_greater(zero, leaning), constant<Number>(-1.0), one);
    const Number gap = one - way * bend;  // to full friction this way
    const Number path = quotient(abs(slid_m), law.length_m);

    const auto builds_up = is_greater(gap, path);
    const Bristle<Number> straight = {select(builds_up, bend + quotient(slid_m, law.length_m), way),
                                      select(builds_up, quotient(one, law.length_m), zero)};
    const auto is_straight = is_equal(law.exponent, zero);
    if (all(is_straight)) return straight;

    const auto is_exponential = is_equal(law.exponent, one);
    Bristle<Number> common = straight;
    if (!all(is_not(is_exponential))) {
        const Number decayed = gap * exp(negative(path));
        common = choose(is_straight, straight,
                        Bristle<Number>{way * (one - decayed), quotient(decayed, law.length_m)});
    }
    const auto is_common = either(is_straight, is_exponential);
    if (all(is_common)) return common;

    // gap^(1 - exponent) falls linearly along the path. The gap is at most 2, and so is that power of it.
    const Number power = select(is_exponential, one, one - law.exponent);
    const Bristle<Number> full = {way, zero};
    if (all(either(is_common, is_greater(power * path, constant<Number>(2.0)))))
        return choose(is_common, common, full);
    const Number left_power = pow(gap, power) - power * path;
    const auto is_left = is_greater(left_power, zero);
    const Number positive_power = select(is_left, left_power, one);
    const Number left = pow(positive_power, one / power);
    const Number left_to_exponent = quotient(left, positive_power);  // of left and left^(1 - exponent)
    const Bristle<Number> general =
        choose(is_left, Bristle<Number>{way * (one - left), quotient(left_to_exponent, law.length_m)}, full);
    return choose(is_common, common, general);
}

CAPSTAN_LAWS_END
#endif
