#include "capstan/estimation/pattern_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "capstan/solver/cable_end.h"

namespace capstan {

namespace {

Affine operator+(Affine a, Affine b) {
    return {a.constant + b.constant, a.per_reading + b.per_reading};
}
Affine operator-(Affine a, Affine b) {
    return {a.constant - b.constant, a.per_reading - b.per_reading};
}
Affine operator*(double factor, Affine a) {
    return {factor * a.constant, factor * a.per_reading};
}
Affine known(double value) {
    return {value, 0.0};
}

StepView view_of(const EstimationProblem& problem) {
    return {problem.model.tables(), problem.model.rules(), problem.previous};
}

// Tension ratio and elongation per newton of a sliding run, relative to its first node.
struct Run {
    std::vector<double> ratio;       // nodes of the run
    std::vector<double> elongation;  // nodes of the run [m/N]
};

Run sliding_run(const EstimationProblem& problem, const DirectionPattern& pattern, int first, int last) {
    const PrefixTables& tables = problem.model.tables();
    const int segments = problem.model.cable().segments();
    Run run{{1.0}, {0.0}};
    for (int segment = first; segment < last; ++segment) {
        const double exponent = sign(pattern.segment(segment, segments)) * tables.sliding_exponent[segment];
        run.elongation.push_back(run.elongation.back() +
                                 run.ratio.back() *
                                     sliding_elongation_m_per_N(problem.model.rules().elongation,
                                                                2.0 * tables.half_compliance_m_per_N[segment],
                                                                exponent));
        run.ratio.push_back(run.ratio.back() * std::exp(exponent));
    }
    return run;
}

// Writes a run whose first node has the given tension and displacement.
void lay(PatternProfile& profile, const Run& run, int first, Affine tension_N, Affine displacement_m) {
    for (std::size_t k = 0; k < run.ratio.size(); ++k) {
        profile.tension_N[first + k] = run.ratio[k] * tension_N;
        profile.displacement_m[first + k] = displacement_m + run.elongation[k] * tension_N;
    }
}

// Narrows an interval to the readings where `value` is above zero.
void demand_positive(ReadingInterval& interval, Affine value) {
    if (value.per_reading == 0.0) {
        if (value.constant < 0.0) interval = {0.0, 0.0};
        return;
    }
    const double root_N = -value.constant / value.per_reading;
    if (value.per_reading > 0.0) interval.low_N = std::max(interval.low_N, root_N);
    if (value.per_reading < 0.0) interval.high_N = std::min(interval.high_N, root_N);
}

// The resting node next to a front holds against it (E4). `outward` is the sign with which tension would have
// to grow away from the moving side for the resting node to join it.
void demand_holding(ReadingInterval& interval, int outward, Affine moving_N, double resting_N, double ratio) {
    if (outward == 0) return;
    demand_positive(interval,
                    outward > 0 ? ratio * moving_N - known(resting_N) : known(resting_N * ratio) - moving_N);
}

}  // namespace

std::optional<PatternProfile> pattern_profile(const EstimationProblem& problem,
                                              const DirectionPattern& pattern, int sensor) {
    const StepView view = view_of(problem);
    const int segments = view.segments();
    const std::vector<double>& half = view.tables.half_compliance_m_per_N;
    const Affine proximal_m = known(problem.proximal_displacement_m);
    const bool all_move = pattern.leading + pattern.trailing == segments;
    const int near_last = all_move ? segments : pattern.leading;  // last node of the proximal side
    const int far_first =
        all_move ? segments + 1 : segments - pattern.trailing;  // first one of the distal side
    const bool distal_side = !all_move && pattern.trailing > 0;
    const bool sensor_near = sensor <= near_last;
    if (!sensor_near && !(distal_side && sensor >= far_first)) return std::nullopt;

    PatternProfile profile;
    for (int node = 0; node <= segments; ++node) {
        profile.tension_N.push_back(known(view.tension_N(node)));
        profile.displacement_m.push_back(known(view.displacement_m(node)));
    }
    const Run near = sliding_run(problem, pattern, 0, near_last);
    Affine near_tension_N{0.0, 1.0 / near.ratio[std::min(sensor, near_last)]};
    if (!sensor_near) {
        const int resting = near_last + 1;  // E3
        near_tension_N = known((view.displacement_m(resting) - half[near_last] * view.tension_N(resting) -
                                problem.proximal_displacement_m) /
                               (near.elongation.back() + half[near_last] * near.ratio.back()));
    }
    lay(profile, near, 0, near_tension_N, proximal_m);
    if (distal_side) {
        if (sensor_near) return std::nullopt;  // nothing says what the distal side does
        const Run far = sliding_run(problem, pattern, far_first, segments);
        const Affine far_tension_N{0.0, 1.0 / far.ratio[sensor - far_first]};
        const Affine far_m =
            known(view.displacement_m(far_first - 1) + half[far_first - 1] * view.tension_N(far_first - 1)) +
            half[far_first - 1] * far_tension_N;
        lay(profile, far, far_first, far_tension_N, far_m);
    }
    return profile;
}

ReadingInterval verified_readings(const EstimationProblem& problem, const DirectionPattern& pattern,
                                  const PatternProfile& profile) {
    const StepView view = view_of(problem);
    const int segments = view.segments();
    ReadingInterval interval{-std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::infinity()};
    const auto increment_m = [&](int node) {
        return profile.displacement_m[node] - known(view.displacement_m(node));
    };
    for (int segment = 0; segment < segments; ++segment) {
        const int way = sign(pattern.segment(segment, segments));
        if (way == 0) continue;
        switch (view.rules.check) {
            case VelocityCheck::every_node:
                demand_positive(interval, way * increment_m(segment));
                demand_positive(interval, way * increment_m(segment + 1));
                break;
            case VelocityCheck::segment_mean:
                demand_positive(interval, way * (increment_m(segment) + increment_m(segment + 1)));
                break;
        }
    }
    if (pattern.leading + pattern.trailing == segments) return interval;

    const int near = pattern.leading;  // last moving node of the proximal side; node 0 always moves
    const Direction near_way = pattern.leading > 0
                                   ? pattern.leading_direction
                                   : direction_of(problem.proximal_displacement_m - view.displacement_m(0));
    demand_holding(interval, sign(near_way), profile.tension_N[near], view.tension_N(near + 1),
                   view.holding_ratio(near));
    if (pattern.trailing > 0) {
        const int far = segments - pattern.trailing;
        demand_holding(interval, -sign(pattern.trailing_direction), profile.tension_N[far],
                       view.tension_N(far - 1), view.holding_ratio(far - 1));
    }
    return interval;
}

}  // namespace capstan
