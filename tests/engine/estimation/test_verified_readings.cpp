// Each branch's interval against its checks, done again by hand at readings just inside and just outside.
#include <gtest/gtest.h>

#include <cmath>

#include "capstan/estimation/single_sensor.h"
#include "paper_experiment.h"

namespace capstan {
namespace {

int segment_way(const DirectionBits& bits, int segment) {
    return static_cast<int>(bits.forward >> segment & 1) - static_cast<int>(bits.backward >> segment & 1);
}

// A segment's elongation [m] while it slides, from the tension of its proximal node and its direction (E2).
double elongation_m(const EstimationProblem& problem, int segment, int way, double tension_N) {
    const Cable& cable = problem.model.cable();
    const double exponent = way * cable.dynamic_friction() * cable.wrap_angle_rad()[segment];
    const double strain_of_one_N = cable.segment_compliance_m_per_N(segment);
    if (problem.model.rules().elongation == ElongationRule::mean_tension) {
        return strain_of_one_N * tension_N * (1.0 + std::exp(exponent)) / 2.0;
    }
    return strain_of_one_N * tension_N * (std::exp(exponent) - 1.0) / exponent;
}

// The two sides of a set of directions: how many segments slide from either end.
struct Sides {
    int leading = 0;
    int trailing = 0;
};

Sides sides_of(const DirectionBits& directions, int segments) {
    Sides sides;
    while (sides.leading < segments && segment_way(directions, sides.leading) != 0) ++sides.leading;
    while (sides.leading + sides.trailing < segments &&
           segment_way(directions, segments - 1 - sides.trailing) != 0) {
        ++sides.trailing;
    }
    return sides;
}

// Displacements that belong to the tensions: the proximal side hangs on the known proximal end, the distal
// one on the node next to it as it was in the step before (E3).
std::vector<double> displacements_m(const EstimationProblem& problem, const DirectionBits& directions,
                                    const std::vector<double>& tension_N) {
    const int segments = problem.model.cable().segments();
    const Sides sides = sides_of(directions, segments);
    std::vector<double> u_m = problem.previous.displacement_m;
    u_m[0] = problem.proximal_displacement_m;
    for (int i = 0; i < sides.leading; ++i) {
        u_m[i + 1] = u_m[i] + elongation_m(problem, i, segment_way(directions, i), tension_N[i]);
    }
    if (sides.trailing == 0) return u_m;
    const int first = segments - sides.trailing;
    u_m[first] = problem.previous.displacement_m[first - 1] +
                 problem.model.cable().segment_compliance_m_per_N(first - 1) *
                     (problem.previous.tension_N[first - 1] + tension_N[first]) / 2.0;
    for (int i = first; i < segments; ++i) {
        u_m[i + 1] = u_m[i] + elongation_m(problem, i, segment_way(directions, i), tension_N[i]);
    }
    return u_m;
}

// E5: the cable moved the way that the pattern says.
bool moved_its_way(const EstimationProblem& problem, const DirectionBits& directions,
                   const std::vector<double>& u_m) {
    for (int i = 0; i < problem.model.cable().segments(); ++i) {
        const int way = segment_way(directions, i);
        const double here_m = way * (u_m[i] - problem.previous.displacement_m[i]);
        const double next_m = way * (u_m[i + 1] - problem.previous.displacement_m[i + 1]);
        if (way == 0) continue;
        if (problem.model.rules().check == VelocityCheck::every_node && (here_m < 0.0 || next_m < 0.0))
            return false;
        if (problem.model.rules().check == VelocityCheck::segment_mean && here_m + next_m < 0.0) return false;
    }
    return true;
}

// E4: across the segment next to a front, tension changes by less than friction can hold, in the direction in
// which the moving side drags. With a single segment at rest between two sides each front is still held
// against the state before, as the paper does; the step's own check (E8) compares the two fronts.
bool front_holds(const EstimationProblem& problem, int segment, double upstream_N, double downstream_N) {
    const Cable& cable = problem.model.cable();
    const bool slid =
        segment_direction(problem.previous.last_motion, segment, cable.segments()) != Direction::none;
    const bool dynamic = slid && problem.model.rules().stiction == StictionRule::remembers_sliding;
    const double friction = dynamic ? cable.dynamic_friction() : cable.static_friction();
    return downstream_N < upstream_N * std::exp(friction * cable.wrap_angle_rad()[segment]);
}

bool checks_hold(const EstimationProblem& problem, const DirectionBits& directions,
                 const std::vector<double>& tension_N) {
    const int segments = problem.model.cable().segments();
    const std::vector<double> u_m = displacements_m(problem, directions, tension_N);
    if (!moved_its_way(problem, directions, u_m)) return false;
    const Sides sides = sides_of(directions, segments);
    if (sides.leading + sides.trailing == segments) return true;
    // A segment is dragged forward if tension is higher at its distal node.
    const int near = sides.leading;
    const int near_way = near > 0 ? segment_way(directions, near - 1)
                                  : sign(direction_of(u_m[0] - problem.previous.displacement_m[0]));
    const double near_N = tension_N[near];
    const double resting_N = problem.previous.tension_N[near + 1];
    if (near_way > 0 && !front_holds(problem, near, near_N, resting_N)) return false;
    if (near_way < 0 && !front_holds(problem, near, resting_N, near_N)) return false;
    if (sides.trailing == 0) return true;
    const int far = segments - sides.trailing;
    const int far_way = segment_way(directions, far);
    const double resting_before_far_N = problem.previous.tension_N[far - 1];
    if (far_way > 0) return front_holds(problem, far - 1, resting_before_far_N, tension_N[far]);
    return front_holds(problem, far - 1, tension_N[far], resting_before_far_N);
}

void expect_intervals_to_end_where_checks_fail(const test::Instant& instant, DistalSide distal_side) {
    const EstimationProblem problem = instant.problem();
    const SingleSensorEstimator estimator(problem, distal_side);
    int ends = 0;
    for (int sensor = 0; sensor < instant.nodes(); ++sensor) {
        for (const SensorBranch& branch : estimator.branches(sensor)) {
            if (!branch.verified) continue;
            const auto holds_at = [&](double reading_N) {
                std::vector<double> tension_N;
                for (int i = 0; i < instant.nodes(); ++i) tension_N.push_back(branch.tension_N(i, reading_N));
                return checks_hold(problem, branch.directions, tension_N);
            };
            const double step_N = std::min(1e-6, 0.01 * (branch.high_N - branch.low_N));
            if (std::isfinite(branch.low_N)) {
                EXPECT_TRUE(holds_at(branch.low_N + step_N))
                    << "sensor " << sensor << ", low " << branch.low_N;
                EXPECT_FALSE(holds_at(branch.low_N - step_N))
                    << "sensor " << sensor << ", low " << branch.low_N;
                ++ends;
            }
            if (std::isfinite(branch.high_N)) {
                EXPECT_TRUE(holds_at(branch.high_N - step_N))
                    << "sensor " << sensor << ", high " << branch.high_N;
                EXPECT_FALSE(holds_at(branch.high_N + step_N))
                    << "sensor " << sensor << ", high " << branch.high_N;
                ++ends;
            }
        }
    }
    EXPECT_GT(ends, instant.nodes()) << "few intervals had an end to look at";
}

TEST(VerifiedReadings, EndWhereTheChecksFailUnderThePapersRules) {
    for (const int sample : {112, 142, 6, 104}) {
        SCOPED_TRACE("sample " + std::to_string(sample));
        expect_intervals_to_end_where_checks_fail(test::paper_instant(sample), DistalSide::excluded);
        expect_intervals_to_end_where_checks_fail(test::paper_instant(sample), DistalSide::admitted);
    }
}

TEST(VerifiedReadings, EndWhereTheChecksFailUnderTheConsistentRules) {
    const QuasiStaticStep step(test::paper_cable(10), ModelRules::consistent());
    for (const int sample : {112, 142, 6, 104}) {
        SCOPED_TRACE("sample " + std::to_string(sample));
        expect_intervals_to_end_where_checks_fail(test::instant_of(step, sample), DistalSide::admitted);
    }
}

TEST(VerifiedReadings, EndWhereTheChecksFailOnSegmentsOfUnequalLength) {
    CableSpecification uneven = test::paper_specification(9);
    uneven.node_places_m = {0.1, 0.25, 1.1, 1.4};
    const QuasiStaticStep step(Cable(uneven), ModelRules::consistent());
    for (const int sample : {112, 142, 6, 104}) {
        SCOPED_TRACE("sample " + std::to_string(sample));
        expect_intervals_to_end_where_checks_fail(test::instant_of(step, sample), DistalSide::admitted);
    }
}

}  // namespace
}  // namespace capstan
