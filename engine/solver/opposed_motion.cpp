#include <cmath>

#include "capstan/solver/pattern_search.h"

namespace capstan {

namespace {

// The proximal nodes up to the segment's first slide one way, the others against them; the velocity is zero
// at a fraction of the segment, which carries exponent (2 fraction - 1) (E7). A search tries many fractions.
class OpposedInSegment {
  public:
    OpposedInSegment(const StepView& view, const EndConditions& ends, Direction proximal, int segment)
        : view_(view),
          ends_(ends),
          proximal_(proximal),
          segment_(segment),
          near_(view.tables.proximal(sign(proximal))),
          far_(view.tables.distal(-sign(proximal))),
          exponent_(view.tables.sliding_exponent[segment] * sign(proximal)) {}

    // False where it needs a tension of zero or less.
    bool solve(double fraction) {
        fraction_ = fraction;
        const double ratio = near_.tension_ratio[segment_] * std::exp(exponent_ * (2.0 * fraction - 1.0)) /
                             far_.tension_ratio[segment_ + 1];
        const double elongation =
            near_.front_compliance_m_per_N[segment_] + ratio * far_.front_compliance_m_per_N[segment_ + 1];
        at_proximal_ = proximal_values(ends_, ratio, elongation);
        at_distal_ = {at_proximal_.tension_N * ratio,
                      at_proximal_.displacement_m + at_proximal_.tension_N * elongation};
        is_taut_ = at_proximal_.tension_N > 0.0;
        if (!is_taut_) at_proximal_ = at_distal_ = slack(ends_).distal;
        return is_taut_;
    }

    // How far the segment's first node, or its second, moves along the proximal side's direction.
    double first_increment_m() const {
        const double now_m =
            at_proximal_.displacement_m + at_proximal_.tension_N * near_.elongation_m_per_N[segment_];
        return sign(proximal_) * (now_m - view_.displacement_m(segment_));
    }
    double second_increment_m() const {
        const double now_m =
            at_distal_.displacement_m - at_distal_.tension_N * far_.elongation_m_per_N[segment_ + 1];
        return sign(proximal_) * (now_m - view_.displacement_m(segment_ + 1));
    }

    // Velocity, interpolated between both nodes, at the assumed zero-velocity point; zero when it is one.
    double mismatch_m() const {
        return (1.0 - fraction_) * first_increment_m() + fraction_ * second_increment_m();
    }

    Candidate candidate() const {
        if (!is_taut_) return slack(ends_);
        return {{MotionKind::opposed, proximal_, opposite(proximal_), segment_ + 1,
                 view_.segments() - segment_, fraction_},
                at_proximal_,
                at_distal_};
    }

  private:
    const StepView& view_;
    const EndConditions& ends_;
    Direction proximal_;
    int segment_;
    const SideTable& near_;
    const SideTable& far_;
    double exponent_;
    double fraction_ = 0.0;
    bool is_taut_ = false;
    EndValues at_proximal_;
    EndValues at_distal_;
};

// Whether a node moves with the proximal end in the pattern whose direction changes exactly there.
bool moves_with_proximal(const StepView& view, const EndConditions& ends, Direction proximal, int node) {
    if (node < view.segments()) {
        OpposedInSegment at_first(view, ends, proximal, node);
        return at_first.solve(0.0) && at_first.first_increment_m() > 0.0;
    }
    OpposedInSegment at_last(view, ends, proximal, node - 1);
    return at_last.solve(1.0) && at_last.second_increment_m() > 0.0;
}

}  // namespace

[[gnu::noinline]] Candidate opposed_motion(const StepView& view, const EndConditions& ends,
                                           Direction proximal) {
    // Nodes before the zero-velocity point move with the proximal end, those behind it do not.
    if (!moves_with_proximal(view, ends, proximal, 0)) return mass_motion(view, ends, opposite(proximal));
    if (moves_with_proximal(view, ends, proximal, view.segments())) return mass_motion(view, ends, proximal);
    int with = 0;
    int against = view.segments();
    while (against - with > 1) {
        const int middle = with + (against - with) / 2;
        (moves_with_proximal(view, ends, proximal, middle) ? with : against) = middle;
    }

    // Bracketed secant (Illinois): the mismatch is positive at fraction 0 and not at fraction 1.
    OpposedInSegment within(view, ends, proximal, with);
    double low = 0.0;
    double high = 1.0;
    within.solve(low);
    double at_low = within.mismatch_m();
    within.solve(high);
    double at_high = within.mismatch_m();
    int last_side = 0;
    for (int iteration = 0; iteration < 100 && at_high < 0.0; ++iteration) {
        const double fraction = low + (high - low) * at_low / (at_low - at_high);
        within.solve(fraction);
        const double at_middle = within.mismatch_m();
        if (at_middle == 0.0 || high - low < 1e-15) break;
        if (at_middle > 0.0) {
            if (fraction == low) break;
            low = fraction;
            at_low = at_middle;
            if (last_side > 0) at_high *= 0.5;
            last_side = 1;
        } else {
            if (fraction == high) break;
            high = fraction;
            at_high = at_middle;
            if (last_side < 0) at_low *= 0.5;
            last_side = -1;
        }
        if (std::abs(at_middle) < 1e-18) break;  // below the rounding of any displacement
    }
    return within.candidate();
}

}  // namespace capstan
