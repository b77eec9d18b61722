#include "capstan/estimation/recursive_fusion.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/estimation/consensus.h"
#include "capstan/estimation/pattern_profile.h"

namespace capstan {

namespace {

Direction direction_at(const DirectionBits& bits, int segment) {
    const std::uint64_t bit = std::uint64_t{1} << segment;
    if (bits.forward & bit) return Direction::forward;
    return bits.backward & bit ? Direction::backward : Direction::none;
}

// The motion that directions of single segments describe: what slides from each end.
MotionPattern motion_of(const DirectionBits& bits, int segments) {
    MotionPattern motion;
    motion.proximal_direction = direction_at(bits, 0);
    motion.distal_direction = direction_at(bits, segments - 1);
    int leading = 0;
    while (leading < segments && motion.proximal_direction != Direction::none &&
           direction_at(bits, leading) == motion.proximal_direction)
        ++leading;
    if (leading == segments) {
        motion.kind = MotionKind::mass;
        motion.proximal_moving_nodes = motion.distal_moving_nodes = segments + 1;
        return motion;
    }
    int trailing = 0;
    while (trailing < segments - leading && motion.distal_direction != Direction::none &&
           direction_at(bits, segments - 1 - trailing) == motion.distal_direction)
        ++trailing;
    motion.proximal_moving_nodes = leading > 0 ? leading + 1 : 0;
    motion.distal_moving_nodes = trailing > 0 ? trailing + 1 : 0;
    motion.kind = leading + trailing > 0 ? MotionKind::partial : MotionKind::rest;
    if (leading > 0 && trailing > 0 && leading + trailing == segments) {
        motion.kind = MotionKind::opposed;
        motion.distal_moving_nodes = trailing;
    }
    return motion;
}

}  // namespace

RecursiveFusion::RecursiveFusion(const QuasiStaticStep& model, const CableState& start,
                                 const FusionMethod& method, DistalSide distal_side,
                                 std::span<const double> weight)
    : model_(model), method_(method), estimate_(start), weight_(weight.begin(), weight.end()) {
    const int segments = model.cable().segments();
    if (segments > max_estimated_segments) {
        throw InvalidInput({"segments is " + std::to_string(segments) +
                            ", but the paper's estimators take at most " +
                            std::to_string(max_estimated_segments) + "; use fewer segments"});
    }
    if (!method.averaging || method.knowledge != Knowledge::direction_unknown)
        throw InvalidInput({"over time only the paper's methods with an unknown direction can fuse, not " +
                            std::string(method.name)});
    if (method.uses_weights && weight.size() != static_cast<std::size_t>(segments) + 1)
        throw InvalidInput({std::string(method.name) + " needs a weight for each node"});
    for (const DirectionPattern& pattern : admissible_patterns(segments)) {
        const bool distal_moves = pattern.trailing > 0 && pattern.leading + pattern.trailing < segments;
        if (distal_moves && distal_side == DistalSide::excluded) continue;
        candidates_.push_back({pattern, direction_bits(pattern, segments)});
    }
    order_.resize(candidates_.size());
    std::iota(order_.begin(), order_.end(), 0);
    const auto nodes = static_cast<std::size_t>(segments) + 1;
    tension_N_.assign(nodes * static_cast<std::size_t>(padded_nodes(segments + 1)), 0.0);
    displacement_m_ = tension_N_;
    directions_.assign(nodes, {});
    verified_.assign(nodes, 0);
    order_patterns();
}

// As in SingleSensorEstimator: the previous pattern first, then by Hamming distance from it.
void RecursiveFusion::order_patterns() {
    const int segments = model_.cable().segments();
    ordered_from_ = direction_bits(estimate_.last_motion, segments);
    std::sort(order_.begin(), order_.end(), [&](int a, int b) {
        const int far_a =
            hamming_distance(candidates_[static_cast<std::size_t>(a)].directions, ordered_from_);
        const int far_b =
            hamming_distance(candidates_[static_cast<std::size_t>(b)].directions, ordered_from_);
        return far_a != far_b ? far_a < far_b : a < b;
    });
}

bool RecursiveFusion::estimate_from(const EstimationProblem& problem, const NodeReading& reading) {
    const int nodes = model_.cable().nodes();
    const auto sensor = static_cast<std::size_t>(reading.node);
    const std::size_t start = sensor * static_cast<std::size_t>(padded_nodes(nodes));
    double* profile_N = tension_N_.data() + start;
    double* profile_m = displacement_m_.data() + start;
    for (const int index : order_) {
        const Candidate& candidate = candidates_[static_cast<std::size_t>(index)];
        const auto profile = pattern_profile(problem, candidate.pattern, reading.node);
        if (!profile) continue;
        const ReadingInterval interval = verified_readings(problem, candidate.pattern, *profile);
        if (!(interval.low_N < reading.value_N && reading.value_N < interval.high_N)) continue;
        for (int node = 0; node < nodes; ++node) {
            const Affine& tension = profile->tension_N[static_cast<std::size_t>(node)];
            profile_N[node] = tension.constant + tension.per_reading * reading.value_N;
            const Affine& displacement = profile->displacement_m[static_cast<std::size_t>(node)];
            profile_m[node] = displacement.constant + displacement.per_reading * reading.value_N;
        }
        directions_[sensor] = candidate.directions;
        verified_[sensor] = 1;
        return true;
    }
    std::copy(estimate_.tension_N.begin(), estimate_.tension_N.end(), profile_N);
    std::copy(estimate_.displacement_m.begin(), estimate_.displacement_m.end(), profile_m);
    directions_[sensor] = ordered_from_;
    verified_[sensor] = 0;
    return false;
}

int RecursiveFusion::step(double proximal_displacement_m, std::span<const NodeReading> readings) {
    const int nodes = model_.cable().nodes();
    if (readings.empty()) throw InvalidInput({"the paper's estimators need at least one reading a step"});
    for (const NodeReading& reading : readings) {
        if (reading.node < 0 || reading.node >= nodes)
            throw InvalidInput({"a sensor at node " + std::to_string(reading.node) +
                                "; the cable's nodes are 0 to " + std::to_string(nodes - 1)});
    }
    if (direction_bits(estimate_.last_motion, nodes - 1) != ordered_from_) order_patterns();
    const EstimationProblem problem{model_, estimate_, proximal_displacement_m};
    std::vector<int> sensors;
    int unverified = 0;
    for (const NodeReading& reading : readings) {
        if (!estimate_from(problem, reading)) ++unverified;
        sensors.push_back(reading.node);
    }
    std::sort(sensors.begin(), sensors.end());

    FusionInput input;
    input.sensors = sensors;
    input.unknown = {nodes, tension_N_, directions_, verified_};
    const SensorVote vote = take_vote(input.unknown, sensors);
    input.vote = &vote;
    input.weight = weight_;
    std::vector<DirectionBits> votes;
    for (const int sensor : vote.sensors()) votes.push_back(directions_[static_cast<std::size_t>(sensor)]);
    const DirectionBits median = median_direction(votes, nodes - 1).directions;
    method_.fuse(input, estimate_.tension_N);
    fuse_displacements(input);
    estimate_.last_motion = motion_of(median, nodes - 1);
    return unverified;
}

// A fused profile is linear in the single ones, so displacements are fused as tensions are. Where a method
// does not share out all weight, what it makes of ones is the part that it shares out: a displacement has no
// natural zero that it could be made smaller towards.
void RecursiveFusion::fuse_displacements(FusionInput& input) {
    input.unknown.tension_N = displacement_m_;
    method_.fuse(input, estimate_.displacement_m);
    if (method_.averaging->disagreeing != Averaging::Disagreeing::left_out_unshared) return;
    const std::vector<double> ones(displacement_m_.size(), 1.0);
    std::vector<double> shared_out(estimate_.displacement_m.size());
    input.unknown.tension_N = ones;
    method_.fuse(input, shared_out);
    for (std::size_t node = 0; node < shared_out.size(); ++node)
        estimate_.displacement_m[node] /= shared_out[node];
}

}  // namespace capstan
