#include "capstan/reference/assumed_pattern.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace capstan::reference {

namespace {

// Relative rounding of a tension against the friction cone (E4).
constexpr double tension_rounding = 1e-10;

class Search {
  public:
    Search(PatternSolver& solver, const StepProblem& problem)
        : solver_(solver), problem_(problem), tried_(problem.before) {}

    // The verified state, with the pattern as its last motion; nothing if no pattern verifies.
    std::optional<CableState> run() {
        const Direction proximal = driven_direction(true);
        const Direction distal = driven_direction(false);
        if (from_fronts(proximal, distal, true) || from_fronts(proximal, distal, false)) return tried_;
        for (const Direction direction : {Direction::forward, Direction::backward}) {
            if (assume(mass(direction)) && verified()) return tried_;
            if (opposed(direction)) return tried_;
        }
        return std::nullopt;
    }

    int systems() const { return systems_; }

  private:
    int nodes() const { return problem_.nodes(); }

    // Which way an end node would go alone against its resting neighbour (E3 with E6).
    Direction driven_direction(bool proximal) const {
        const EndCondition& end = proximal ? problem_.ends.proximal : problem_.ends.distal;
        const int node = proximal ? 0 : problem_.segments();
        const double outward = proximal ? -1.0 : 1.0;
        const double by_displacement = end.displacement_factor * problem_.before.displacement_m[node];
        const double by_tension = end.tension_factor * problem_.before.tension_N[node];
        const double change = end.value - by_displacement - by_tension;
        const double rounding =
            1e-14 * (std::abs(end.value) + std::abs(by_displacement) + std::abs(by_tension));
        if (std::abs(change) <= rounding) return Direction::none;
        const std::vector<double>& length = problem_.cable.relative_length;
        const double h = problem_.cable.half_compliance_m_per_N * (proximal ? length.front() : length.back());
        const double scale = end.displacement_factor * h + outward * end.tension_factor;
        return direction_of(change * scale);
    }

    bool assume(const MotionPattern& pattern) {
        ++systems_;
        tried_.last_motion = pattern;
        return solver_.solve(problem_, pattern, tried_);
    }

    MotionPattern mass(Direction direction) const {
        return {MotionKind::mass, direction, direction, nodes(), nodes(), 0.0};
    }

    int remembered(bool proximal, Direction direction) const {
        const MotionPattern& last = problem_.before.last_motion;
        const Direction before = proximal ? last.proximal_direction : last.distal_direction;
        const int count = proximal ? last.proximal_moving_nodes : last.distal_moving_nodes;
        return before == direction ? count : 0;
    }

    // The tensions at both nodes of the segment beyond a front: its moving node's as just solved, its resting
    // one's as it was.
    struct Front {
        int segment;
        double proximal_N;
        double distal_N;
    };
    Front near_front(int near) const {
        return {near - 1, tried_.tension_N[near - 1], problem_.before.tension_N[near]};
    }
    Front far_front(int far) const {
        const int first = nodes() - far;
        return {first - 1, problem_.before.tension_N[first - 1], tried_.tension_N[first]};
    }
    double holding_ratio(int segment) const {
        return (problem_.slid(segment) ? problem_.cable.sliding_ratio
                                       : problem_.cable.breakaway_ratio)[segment];
    }
    // E4: the resting node is carried along in `direction`.
    bool gives_way(const Front& front, Direction direction) const {
        const double ratio = holding_ratio(front.segment);
        return direction == Direction::forward ? front.distal_N >= front.proximal_N * ratio
                                               : front.proximal_N >= front.distal_N * ratio;
    }
    // Within both sides of the friction cone.
    static bool in_cone(const Front& front, double holding_ratio) {
        const double ratio = holding_ratio * (1.0 + tension_rounding);
        return front.proximal_N <= front.distal_N * ratio && front.distal_N <= front.proximal_N * ratio;
    }

    // Both fronts go on until they hold, or meet.
    bool from_fronts(Direction proximal, Direction distal, bool remember) {
        const auto first_count = [&](bool near, Direction direction) {
            if (direction == Direction::none) return 0;
            return std::max(1, remember ? remembered(near, direction) : 0);
        };
        int near = first_count(true, proximal);
        int far = first_count(false, distal);
        bool near_moves_on = true;
        bool far_moves_on = true;
        while (near + far < nodes() && (near_moves_on || far_moves_on)) {
            const bool rests = near + far == 0;
            if (!assume({rests ? MotionKind::rest : MotionKind::partial, proximal, distal, near, far, 0.0})) {
                return false;
            }
            near_moves_on = near > 0 && gives_way(near_front(near), proximal);
            far_moves_on = far > 0 && gives_way(far_front(far), distal);
            near += near_moves_on;
            far += far_moves_on;
        }
        if (near + far < nodes()) return verified();
        if (proximal != Direction::none && distal == opposite(proximal)) return opposed(proximal);
        // E8: the middle of the segment that stops both fronts.
        if (proximal == distal && near + far == nodes() &&
            assume({MotionKind::partial, proximal, distal, near, far, 0.0}) && verified()) {
            return true;
        }
        return assume(mass(proximal != Direction::none ? proximal : distal)) && verified();
    }

    // How far the point assumed to have no velocity moved along the proximal side's direction.
    double mismatch_m() const {
        const int near = tried_.last_motion.proximal_moving_nodes;
        const double fraction = tried_.last_motion.zero_velocity_fraction;
        return sign(tried_.last_motion.proximal_direction) *
               ((1.0 - fraction) * increment_m(near - 1) + fraction * increment_m(near));
    }

    // E7: the segment by bisection, then the fraction by bisection.
    bool opposed(Direction proximal) {
        const auto mismatch_at = [&](int segment, double fraction) -> std::optional<double> {
            if (!assume({MotionKind::opposed, proximal, opposite(proximal), segment + 1,
                         problem_.segments() - segment, fraction})) {
                return std::nullopt;
            }
            return mismatch_m();
        };
        int low_segment = 0;
        int high_segment = problem_.segments() - 1;
        while (low_segment < high_segment) {
            const int middle = (low_segment + high_segment) / 2;
            const auto at_end = mismatch_at(middle, 1.0);
            if (!at_end) return false;
            if (*at_end > 0.0) {
                low_segment = middle + 1;
            } else {
                high_segment = middle;
            }
        }
        double low = 0.0;
        double high = 1.0;
        const auto at_low = mismatch_at(low_segment, low);
        const auto at_high = mismatch_at(low_segment, high);
        if (!at_low || !at_high) return false;
        // The point falls off an end: all slides one way.
        if (*at_low < 0.0) return assume(mass(opposite(proximal))) && verified();
        if (*at_high > 0.0) return assume(mass(proximal)) && verified();
        for (int halvings = 0; halvings < 53; ++halvings) {
            const double middle = 0.5 * (low + high);
            const auto at_middle = mismatch_at(low_segment, middle);
            if (!at_middle) return false;
            (*at_middle > 0.0 ? low : high) = middle;
        }
        return verified();
    }

    double increment_m(int node) const {
        return tried_.displacement_m[node] - problem_.before.displacement_m[node];
    }

    // E4 and E5 for what is in `tried_`.
    bool verified() const {
        const MotionPattern& pattern = tried_.last_motion;
        for (int node = 0; node < nodes(); ++node) {
            if (!(tried_.tension_N[node] > 0.0)) return false;  // slack is not covered
            const Direction direction = node_direction(pattern, node, problem_.segments());
            if (sign(direction) * increment_m(node) < -displacement_rounding_m) return false;
        }
        if (pattern.kind == MotionKind::mass || pattern.kind == MotionKind::opposed) return true;
        const int near = pattern.proximal_moving_nodes;
        const int far = pattern.distal_moving_nodes;
        if (near + far == nodes()) {  // E8: both nodes of the held segment slide
            return in_cone({near - 1, tried_.tension_N[near - 1], tried_.tension_N[near]},
                           problem_.cable.sliding_ratio[near - 1]);
        }
        return (near == 0 || in_cone(near_front(near), holding_ratio(near - 1))) &&
               (far == 0 || in_cone(far_front(far), holding_ratio(nodes() - far - 1)));
    }

    PatternSolver& solver_;
    const StepProblem& problem_;
    CableState tried_;
    int systems_ = 0;
};

}  // namespace

ReferenceReport advance_by_assumption(PatternSolver& solver, const CableConstants& cable, CableState& state,
                                      const EndConditions& ends) {
    const StepProblem problem{cable, state, ends};
    Search search(solver, problem);
    const auto after = search.run();
    if (after) state = *after;
    return {after.has_value(), 0.0, search.systems()};
}

}  // namespace capstan::reference
