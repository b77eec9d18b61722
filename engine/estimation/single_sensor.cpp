#include "capstan/estimation/single_sensor.h"

#include <algorithm>
#include <limits>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/estimation/pattern_profile.h"

namespace capstan {

namespace {

SensorBranch branch_of(const DirectionPattern& pattern, int segments, const PatternProfile& profile,
                       const ReadingInterval& interval) {
    SensorBranch branch;
    branch.directions = direction_bits(pattern, segments);
    branch.low_N = interval.low_N;
    branch.high_N = interval.high_N;
    for (const Affine& tension : profile.tension_N) {
        branch.intercept_N.push_back(tension.constant);
        branch.slope.push_back(tension.per_reading);
    }
    return branch;
}

SensorBranch previous_state_branch(const CableState& previous, int segments) {
    SensorBranch branch;
    branch.directions = direction_bits(previous.last_motion, segments);
    branch.verified = false;
    branch.low_N = -std::numeric_limits<double>::infinity();
    branch.high_N = std::numeric_limits<double>::infinity();
    branch.intercept_N = previous.tension_N;
    branch.slope.assign(previous.tension_N.size(), 0.0);
    return branch;
}

std::vector<DirectionPattern> by_distance_from(const DirectionBits& previous, int segments,
                                               PatternOrder order) {
    std::vector<DirectionPattern> patterns = admissible_patterns(segments);
    std::stable_sort(patterns.begin(), patterns.end(),
                     [&](const DirectionPattern& a, const DirectionPattern& b) {
                         return hamming_distance(direction_bits(a, segments), previous) <
                                hamming_distance(direction_bits(b, segments), previous);
                     });
    if (order == PatternOrder::farthest_first) std::reverse(patterns.begin(), patterns.end());
    return patterns;
}

// The admissible pattern that a true motion is nearest to: an opposed motion changes direction where its
// zero-velocity point is.
DirectionPattern pattern_of(const MotionPattern& truth, int segments) {
    if (truth.kind == MotionKind::mass) return {segments, 0, truth.proximal_direction, Direction::none};
    DirectionPattern pattern{std::max(truth.proximal_moving_nodes - 1, 0),
                             std::max(truth.distal_moving_nodes - 1, 0), truth.proximal_direction,
                             truth.distal_direction};
    if (truth.kind == MotionKind::opposed) {
        (truth.zero_velocity_fraction > 0.5 ? pattern.leading : pattern.trailing) += 1;
    }
    return pattern;
}

}  // namespace

SingleSensorEstimator::SingleSensorEstimator(const EstimationProblem& problem, DistalSide distal_side,
                                             PatternOrder order) {
    const int segments = problem.model.cable().segments();
    if (segments > max_estimated_segments) {
        throw InvalidInput({"segments is " + std::to_string(segments) +
                            ", but the paper's estimators take at most " +
                            std::to_string(max_estimated_segments) + "; use fewer segments"});
    }
    const std::vector<DirectionPattern> patterns =
        by_distance_from(direction_bits(problem.previous.last_motion, segments), segments, order);
    branches_.resize(segments + 1);
    for (int sensor = 0; sensor <= segments; ++sensor) {
        for (const DirectionPattern& pattern : patterns) {
            const bool distal_moves = pattern.trailing > 0 && pattern.leading + pattern.trailing < segments;
            if (distal_moves && distal_side == DistalSide::excluded) continue;
            const auto profile = pattern_profile(problem, pattern, sensor);
            if (!profile) continue;
            const ReadingInterval interval = verified_readings(problem, pattern, *profile);
            if (interval.low_N < interval.high_N) {
                branches_[sensor].push_back(branch_of(pattern, segments, *profile, interval));
            }
        }
        branches_[sensor].push_back(previous_state_branch(problem.previous, segments));
    }
}

SingleSensorEstimator::Choice SingleSensorEstimator::choose(int sensor, double reading_N) const {
    const std::vector<SensorBranch>& branches = branches_[sensor];
    const int fallback = static_cast<int>(branches.size()) - 1;
    Choice choice{fallback, 0};
    for (int k = 0; k < fallback; ++k) {
        if (branches[k].low_N < reading_N && reading_N < branches[k].high_N) {
            if (choice.verifying_patterns++ == 0) choice.branch = k;
        }
    }
    return choice;
}

std::optional<SensorBranch> known_direction_branch(const EstimationProblem& problem,
                                                   const MotionPattern& truth, int sensor) {
    const int segments = problem.model.cable().segments();
    if (truth.kind == MotionKind::slack) return std::nullopt;
    const DirectionPattern pattern = pattern_of(truth, segments);
    const auto profile = pattern_profile(problem, pattern, sensor);
    if (!profile) return std::nullopt;
    return branch_of(pattern, segments, *profile,
                     {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()});
}

}  // namespace capstan
