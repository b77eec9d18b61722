#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "capstan/solver/candidate.h"

namespace capstan {

// One side of a step: which way its end drives it, and how far its front goes. The two sides know nothing of
// each other.

/// An input's change within this fraction of the sizes that it is the difference of is rounding.
inline constexpr double input_rounding = 64.0 * std::numeric_limits<double>::epsilon();

/// Which way an end node would go if it moved alone against its resting neighbour (E3 with E6); an input that
/// has not changed beyond rounding drives nothing.
template <End which>
Direction driven_direction(const CableEnd<which>& end) {
    const StepView& view = end.view;
    const EndCondition& condition = end.condition;
    const double displacement_part = condition.displacement_factor * view.displacement_m(end.node(0));
    const double tension_part = condition.tension_factor * view.tension_N(end.node(0));
    const double change = condition.value - (displacement_part + tension_part);
    const double displacement_scale_m =
        std::abs(view.displacement_m(0)) + std::abs(view.displacement_m(view.segments()));
    const double rounding = input_rounding * (std::abs(condition.displacement_factor) * displacement_scale_m +
                                              std::abs(tension_part) + std::abs(condition.value));
    if (std::abs(change) <= rounding) return Direction::none;
    // The increment is h / this times the change, and h is positive.
    const double change_per_increment =
        condition.displacement_factor * view.tables.half_compliance_m_per_N[end.segment(0)] -
        end.orientation * condition.tension_factor;
    return (change > 0.0) != std::signbit(change_per_increment) ? Direction::forward : Direction::backward;
}

/// True if the resting node next to the front cannot hold and joins the motion (E4).
template <End which>
bool neighbour_gives_way(const CableEnd<which>& end, Direction direction, int moving_nodes,
                         double last_tension_N) {
    const double resting_tension_N = end.view.tension_N(end.node(moving_nodes));
    const double ratio = end.view.holding_ratio(end.segment(moving_nodes - 1));
    return end.orientation * sign(direction) > 0 ? resting_tension_N >= last_tension_N * ratio
                                                 : last_tension_N >= resting_tension_N * ratio;
}

/// How many nodes the side moved in the step before, if it goes on the same way; else 0: start at the end.
template <End which>
int remembered_front(const CableEnd<which>& end, Direction direction) {
    if (end.view.before.last_motion.kind == MotionKind::slack) return end.view.nodes();
    return end.last_direction() == direction ? end.last_moving_nodes() : 0;
}

enum class FrontStart { remembered, end_of_cable };

/// The side as its end drives it; nothing moves where the input has not changed.
template <End which>
class SideSearch {
  public:
    SideSearch(const CableEnd<which>& end, FrontStart start)
        : end_(end),
          direction_(driven_direction(end)),
          first_count_(direction_ == Direction::none     ? 0
                       : start == FrontStart::remembered ? std::max(remembered_front(end, direction_), 1)
                                                         : 1) {}

    /// At least so many nodes move.
    int first_count() const { return first_count_; }

    /// Moves the front on until its resting neighbour holds; all nodes when nothing holds it up to
    /// `most_count`.
    SideMotion front(int most_count) const {
        if (direction_ == Direction::none) return {};
        const SideTable& table = end_.table(direction_);
        const int last_count = std::min(most_count, end_.view.segments());
        for (int count = first_count_; count <= last_count; ++count) {
            const EndValues values = end_.partial_motion(table, count);
            const double last_tension_N = values.tension_N * table.tension_ratio[end_.node(count - 1)];
            if (!neighbour_gives_way(end_, direction_, count, last_tension_N))
                return {direction_, count, values};
        }
        return {direction_, end_.view.nodes(), {}};
    }

  private:
    CableEnd<which> end_;
    Direction direction_;
    int first_count_;
};

}  // namespace capstan
