// A step of fusion over time against the estimators that take one reading: both start from the same state.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <random>
#include <vector>

#include "capstan/estimation/consensus.h"
#include "capstan/estimation/fusion_method.h"
#include "capstan/estimation/recursive_fusion.h"
#include "capstan/estimation/single_sensor.h"
#include "paper_experiment.h"

namespace capstan {
namespace {

using test::Instant;

constexpr int fused_segments = 10;

struct ExpectedStep {
    std::vector<double> tension_N;  // nodes
    std::vector<int> counting;      // sensors that the vote does not leave out
    DirectionBits median;           // of those
    int unverified = 0;
};

ExpectedStep expected_step(const EstimationProblem& problem, const FusionMethod& method,
                           DistalSide distal_side, const std::vector<NodeReading>& readings,
                           const std::vector<double>& weight) {
    const SingleSensorEstimator estimator(problem, distal_side);
    const int nodes = estimator.nodes();
    std::vector<double> single_N(static_cast<std::size_t>(nodes * padded_nodes(nodes)));
    std::vector<DirectionBits> directions(nodes);
    std::vector<std::uint8_t> verified(nodes);
    std::vector<int> sensors;
    ExpectedStep expected;
    for (const NodeReading& reading : readings) {
        const auto choice = estimator.choose(reading.node, reading.value_N);
        const SensorBranch& branch = estimator.branches(reading.node)[choice.branch];
        for (int node = 0; node < nodes; ++node)
            single_N[reading.node * padded_nodes(nodes) + node] = branch.tension_N(node, reading.value_N);
        directions[reading.node] = branch.directions;
        verified[reading.node] = branch.verified;
        expected.unverified += branch.verified ? 0 : 1;
        sensors.push_back(reading.node);
    }
    std::sort(sensors.begin(), sensors.end());
    const SensorEstimates unknown{nodes, single_N, directions, verified};
    const SensorVote vote = take_vote(unknown, sensors);
    std::vector<DirectionBits> votes;
    for (const int sensor : vote.sensors()) {
        expected.counting.push_back(sensor);
        votes.push_back(directions[sensor]);
    }
    expected.median = median_direction(votes, nodes - 1).directions;
    expected.tension_N.resize(nodes);
    FusionInput input;
    input.sensors = sensors;
    input.unknown = unknown;
    input.vote = &vote;
    input.weight = weight;
    method.fuse(input, expected.tension_N);
    return expected;
}

std::optional<DirectionPattern> pattern_with(const DirectionBits& bits) {
    for (const DirectionPattern& pattern : admissible_patterns(fused_segments)) {
        if (direction_bits(pattern, fused_segments) == bits) return pattern;
    }
    return std::nullopt;
}

MotionKind kind_of(const DirectionPattern& pattern) {
    if (pattern.leading == fused_segments) return MotionKind::mass;
    if (pattern.leading + pattern.trailing == 0) return MotionKind::rest;
    return pattern.leading > 0 && pattern.leading + pattern.trailing == fused_segments ? MotionKind::opposed
                                                                                       : MotionKind::partial;
}

// A node moves with the fused_segments beside it; where the direction changes, with the proximal one.
Direction way_of_node(const DirectionPattern& pattern, int node) {
    if (pattern.leading > 0 && node <= pattern.leading) return pattern.leading_direction;
    return pattern.trailing > 0 && node >= fused_segments - pattern.trailing ? pattern.trailing_direction
                                                                             : Direction::none;
}

// Readings of some sensors around the truth, in any order; far off now and then, so that no pattern verifies.
std::vector<NodeReading> random_readings(const Instant& instant, std::mt19937_64& random) {
    std::uniform_real_distribution<double> factor(0.3, 1.8);
    std::vector<NodeReading> readings;
    for (int node = 0; node <= fused_segments; ++node) {
        if (random() % 2 == 0) continue;
        const double around_N = factor(random) * instant.truth.tension_N[node];
        readings.push_back({node, random() % 10 == 0 ? -20.0 : around_N});
    }
    if (readings.empty()) readings.push_back({0, instant.truth.tension_N[0]});
    std::shuffle(readings.begin(), readings.end(), random);
    return readings;
}

struct Stepped {
    const CableState& before;
    double proximal_m;
    const std::vector<NodeReading>& readings;
    const ExpectedStep& expected;
    int unverified;
    const CableState& after;
};

// Every step of random readings from a few instants of the paper's experiment.
template <class Judge>
void for_each_step(const QuasiStaticStep& model, const FusionMethod& method, DistalSide distal_side,
                   const Judge& judge) {
    std::mt19937_64 random(20);
    std::vector<double> weight;
    for (int node = 0; node <= fused_segments; ++node) weight.push_back(1.0 + 0.3 * node);
    for (const int sample : {1, 6, 13, 25, 38, 40, 75, 104, 112, 142}) {
        const Instant instant = test::instant_of(model, sample);
        for (int repetition = 0; repetition < 4; ++repetition) {
            RecursiveFusion fusion(instant.step, instant.previous, method, distal_side, weight);
            for (int step = 0; step < 3; ++step) {
                const CableState before = fusion.estimate();
                const EstimationProblem problem{instant.step, before,
                                                instant.truth.displacement_m.front() + 1e-4 * step};
                const auto readings = random_readings(instant, random);
                const ExpectedStep expected = expected_step(problem, method, distal_side, readings, weight);
                const int unverified = fusion.step(problem.proximal_displacement_m, readings);
                judge(Stepped{before, problem.proximal_displacement_m, readings, expected, unverified,
                              fusion.estimate()});
            }
        }
    }
}

TEST(RecursiveFusionStep, IsThatOfTheSingleSensorEstimatorsFromItsOwnEstimate) {
    for (const FusionMethod* method : {&mean_method, &mean_r_method, &weighted_mean_method}) {
        for (const DistalSide distal_side : {DistalSide::excluded, DistalSide::admitted}) {
            int partly_verified = 0;
            for_each_step(test::paper_step(), *method, distal_side, [&](const Stepped& step) {
                ASSERT_EQ(step.unverified, step.expected.unverified);
                ASSERT_EQ(step.after.tension_N, step.expected.tension_N);
                if (step.unverified > 0) ++partly_verified;
            });
            EXPECT_GT(partly_verified, 5);
        }
    }
}

// A reading in the middle of what each pattern allows, so that every pattern that can verify has its turn.
TEST(RecursiveFusionStep, MovesTheNodesBesideTheSegmentsThatSlide) {
    std::map<MotionKind, int> seen;
    for (const int sample : {1, 6, 13, 25, 38, 40, 75, 104, 112, 142}) {
        const Instant instant = test::paper_instant(sample);
        const SingleSensorEstimator estimator(instant.problem(), DistalSide::admitted);
        for (int sensor = 0; sensor <= fused_segments; ++sensor) {
            for (const SensorBranch& branch : estimator.branches(sensor)) {
                const double low_N = std::max(branch.low_N, -100.0);
                const NodeReading reading{sensor, 0.5 * (low_N + std::min(branch.high_N, low_N + 1.0))};
                const auto chosen = estimator.choose(sensor, reading.value_N).branch;
                const auto pattern = pattern_with(estimator.branches(sensor)[chosen].directions);
                if (!pattern) continue;
                RecursiveFusion fusion(instant.step, instant.previous, mean_method, DistalSide::admitted);
                fusion.step(instant.truth.displacement_m.front(), {&reading, 1});
                const MotionPattern& motion = fusion.estimate().last_motion;
                ASSERT_EQ(motion.kind, kind_of(*pattern));
                ++seen[motion.kind];
                for (int node = 0; node <= fused_segments; ++node)
                    ASSERT_EQ(node_direction(motion, node, fused_segments), way_of_node(*pattern, node));
                const int moving = motion.proximal_moving_nodes + motion.distal_moving_nodes;
                if (motion.kind == MotionKind::mass) {
                    EXPECT_EQ(motion.proximal_moving_nodes, fused_segments + 1);
                    EXPECT_EQ(motion.distal_moving_nodes, fused_segments + 1);
                } else if (motion.kind == MotionKind::opposed) {
                    EXPECT_EQ(moving, fused_segments + 1);
                } else {
                    const int sides = (pattern->leading > 0) + (pattern->trailing > 0);
                    EXPECT_EQ(moving, pattern->leading + pattern->trailing + sides);
                }
            }
        }
    }
    for (const MotionKind kind :
         {MotionKind::rest, MotionKind::partial, MotionKind::mass, MotionKind::opposed})
        EXPECT_GT(seen[kind], 0) << static_cast<int>(kind);
}

// One reading takes the place of E3 at the front of the proximal side; every other segment is as long as the
// tensions of its ends make it (E2), and what rests stays where it was.
TEST(RecursiveFusionStep, OfOneSensorElongatesEverySegmentButThatOfTheFront) {
    const QuasiStaticStep model(test::paper_cable(fused_segments), ModelRules::consistent());
    const std::vector<double>& half = model.tables().half_compliance_m_per_N;
    for (const int sample : {6, 13, 38, 75, 112}) {
        const Instant instant = test::instant_of(model, sample);
        for (int sensor = 0; sensor <= fused_segments; ++sensor) {
            for (double factor = 0.5; factor < 1.7; factor += 0.1) {
                RecursiveFusion fusion(model, instant.previous, mean_method, DistalSide::admitted);
                const NodeReading reading{sensor, factor * instant.truth.tension_N[sensor]};
                const double proximal_m = instant.truth.displacement_m.front();
                if (fusion.step(proximal_m, {&reading, 1}) > 0) continue;
                const CableState& after = fusion.estimate();
                const int front = after.last_motion.proximal_moving_nodes - 1;
                if (front >= 0) {
                    EXPECT_EQ(after.displacement_m[0], proximal_m);
                }
                EXPECT_NEAR(after.tension_N[sensor], reading.value_N, 1e-12);
                for (int k = 0; k < fused_segments; ++k) {
                    if (k == std::max(front, 0)) continue;
                    EXPECT_NEAR(after.displacement_m[k + 1] - after.displacement_m[k],
                                half[k] * (after.tension_N[k] + after.tension_N[k + 1]), 1e-12);
                }
                for (int node = 0; node <= fused_segments; ++node) {
                    if (node_direction(after.last_motion, node, fused_segments) != Direction::none) continue;
                    EXPECT_EQ(after.displacement_m[node], instant.previous.displacement_m[node]);
                }
            }
        }
    }
}

TEST(RecursiveFusionStep, PutsEveryNodeInTheMiddleOfWhereItsSensorsPutIt) {
    for_each_step(test::paper_step(), mean_method, DistalSide::admitted, [&](const Stepped& step) {
        std::vector<double> sum_m(fused_segments + 1, 0.0);
        for (const int sensor : step.expected.counting) {
            RecursiveFusion alone(test::paper_step(), step.before, mean_method, DistalSide::admitted);
            const auto reading = std::find_if(step.readings.begin(), step.readings.end(),
                                              [&](const auto& each) { return each.node == sensor; });
            alone.step(step.proximal_m, {&*reading, 1});
            for (int node = 0; node <= fused_segments; ++node)
                sum_m[node] += alone.estimate().displacement_m[node];
        }
        for (int node = 0; node <= fused_segments; ++node)
            ASSERT_NEAR(step.after.displacement_m[node],
                        sum_m[node] / static_cast<double>(step.expected.counting.size()), 1e-12);
    });
}

}  // namespace
}  // namespace capstan
