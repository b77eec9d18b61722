#pragma once

#include "capstan/solver/sliding_front.h"

namespace capstan {

/// Both sides as far as they go.
struct Sides {
    SideMotion proximal;
    SideMotion distal;

    bool meet(const StepView& view) const {
        return proximal.moving_nodes + distal.moving_nodes >= view.nodes();
    }
    /// Driven one way, each front stopped by the same segment, whose middle may rest (E8). No other segment's
    /// middle can: a front has passed it because friction did not hold it against a neighbour at rest, and a
    /// neighbour that moves the same way loads it more.
    bool meet_in_one_segment(const StepView& view) const {
        return driven_one_way() && proximal.moving_nodes + distal.moving_nodes == view.nodes();
    }
    bool rest() const { return proximal.moving_nodes + distal.moving_nodes == 0; }
    /// Of sides not driven against each other.
    Direction common_direction() const {
        return proximal.direction != Direction::none ? proximal.direction : distal.direction;
    }
    bool driven_one_way() const { return proximal.direction == distal.direction; }
    bool driven_against_each_other() const {
        return proximal.direction != Direction::none && distal.direction == opposite(proximal.direction);
    }
};

/// Each front as far as it goes; where they meet in more than one segment, one or both of them as if nothing
/// held.
inline Sides find_sides(const StepView& view, const EndConditions& ends, FrontStart start) {
    const SideSearch<End::proximal> proximal({view, ends}, start);
    const SideSearch<End::distal> distal({view, ends}, start);
    const SideMotion near = proximal.front(view.nodes() - distal.first_count());
    return {near, distal.front(view.nodes() - near.moving_nodes)};
}

}  // namespace capstan
