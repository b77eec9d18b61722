// Cutting the cable finer converges to the cable that is not cut. Order 2: the mean-tension elongation (E2)
// is the trapezoidal rule, and where a front stands inside its segment it is off by a part of one segment,
// in which the tension differs from the resting one by that part times the slope. Single halvings scatter
// with that part.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "convergence_order.h"
#include "example_cables.h"
#include "sampled_path.h"

namespace capstan {
namespace {

constexpr std::array segment_counts{10, 20, 40, 80, 160, 320, 640};  // segments
constexpr int finest_segments = 2560;
constexpr double no_stiction = 0.21;

Cable cable_of(int segments, double static_friction) {
    CableSpecification specification = test::paper_specification(segments);
    specification.static_friction = static_friction;
    return Cable(specification);
}

// The end of an uncut cable under uniform tension, moved so far that the front has not arrived: with
// c = mu / R, front at x and a = c x, the tension T0 exp(c (x - s)) (or its inverse when pushed) stretches
// the cable by T0 / (c EA) (exp(a) - 1 - a), pushed by (a - 1 + exp(-a)).
struct UncutCable {
    double tension_N = 10.0;
    double friction_per_m = 0.21 / 0.28;
    double axial_stiffness_N = 2000.0;

    double end_tension_N(double moved_m) const {
        const double way = moved_m < 0.0 ? 1.0 : -1.0;  // pulled: the tension at the end rises
        const auto stretch_m = [&](double exponent) {
            return tension_N / (friction_per_m * axial_stiffness_N) *
                   (way * std::expm1(way * exponent) - exponent) * way;
        };
        double low = 0.0;
        double high = 2.0 * friction_per_m;
        for (int k = 0; k < 100; ++k) {
            const double middle = 0.5 * (low + high);
            (stretch_m(middle) < std::abs(moved_m) ? low : high) = middle;
        }
        return tension_N * std::exp(way * low);
    }
};

class EndMovedBy : public testing::TestWithParam<double> {};  // proximal displacement [m]

TEST_P(EndMovedBy, NeedsTheTensionThatTheUncutCableWould) {
    const double expected_N = UncutCable{}.end_tension_N(GetParam());
    test::ErrorsByHalving errors;
    for (const int segments : segment_counts) {
        const Cable cable = cable_of(segments, no_stiction);
        const test::SampledPath one_step{[](double) { return test::EndMotion{GetParam(), 0.0}; }, 1};
        errors.add(std::abs(one_step.states(cable, 1).front().tension_N.front() - expected_N));
    }
    errors.tell("end tension against the uncut cable [N]");
    EXPECT_NEAR(errors.mean_order(), 2.0, 0.4);
}

INSTANTIATE_TEST_SUITE_P(PulledAndPushed, EndMovedBy,
                         testing::Values(-0.0005, -0.002, -0.004, 0.0005, 0.002, 0.004));

class Cycle : public testing::TestWithParam<test::EndMotion (*)(double)> {
  protected:
    std::vector<CableState> states(int segments, double static_friction) const {
        return test::SampledPath{GetParam(), 50}.states(cable_of(segments, static_friction), 20);
    }
    test::ErrorsByHalving errors(double static_friction) const {
        const auto finest = states(finest_segments, no_stiction);
        test::ErrorsByHalving errors;
        for (const int segments : segment_counts) {
            errors.add(test::mean_difference_N(states(segments, static_friction), finest,
                                               finest_segments / segments));
        }
        return errors;
    }
};

// With both ends driven the zero-velocity point (E7) steps from segment to segment in time, so coarse cuts
// gain order 1 to 1.5 and only the finest reach 2.
TEST_P(Cycle, ConvergesAsSegmentsAreHalved) {
    const auto errors_N = errors(no_stiction);
    errors_N.tell("mean error over a cycle [N]");
    EXPECT_GT(errors_N.mean_order(), 1.2);
}

// What stiction adds belongs to the length of the segments and goes with it.
TEST_P(Cycle, WithStictionConvergesToTheSameCableWithout) {
    const auto errors_N = errors(0.63);
    errors_N.tell("mean distance to the cable without stiction [N]");
    EXPECT_GT(errors_N.mean_order(), 0.5);
}

INSTANTIATE_TEST_SUITE_P(Driven, Cycle, testing::Values(&test::one_end_cycles, &test::both_ends_cycle),
                         [](const auto& which) { return which.index == 0 ? "AtOneEnd" : "AtBothEnds"; });

}  // namespace
}  // namespace capstan
