// Nothing in the equations knows which end is called proximal: a cable with its bends in reverse order, its
// ends swapped and its displacements negated does the mirrored thing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <set>

#include "example_cables.h"
#include "mirror.h"
#include "random_walk.h"

namespace capstan {
namespace {

using test::InputPair;

// Largest differences between a state and the mirror image of its mirrored twin.
struct Apart {
    double tension = 0.0;       // of the largest tension
    double displacement = 0.0;  // of the largest displacement

    void widen(const Apart& other) {
        tension = std::max(tension, other.tension);
        displacement = std::max(displacement, other.displacement);
    }
};

double largest(const std::vector<double>& values) {
    double most = std::numeric_limits<double>::min();
    for (const double value : values) most = std::max(most, std::abs(value));
    return most;
}

Apart apart(const CableState& a, const CableState& b) {
    Apart most;
    for (std::size_t node = 0; node < a.tension_N.size(); ++node) {
        most.widen({std::abs(a.tension_N[node] - b.tension_N[node]) / largest(a.tension_N),
                    std::abs(a.displacement_m[node] - b.displacement_m[node]) / largest(a.displacement_m)});
    }
    return most;
}

// The zero-velocity point is a root, found to rounding.
bool same_motion(const MotionPattern& a, MotionPattern b) {
    if (std::abs(a.zero_velocity_fraction - b.zero_velocity_fraction) > 1e-6) return false;
    b.zero_velocity_fraction = a.zero_velocity_fraction;
    return a == b;
}

void tell(const Apart& most) {
    constexpr double ulp = std::numeric_limits<double>::epsilon();
    std::cout << "    furthest apart, in ulp of the largest in the cable: tension " << most.tension / ulp
              << ", displacement " << most.displacement / ulp << "\n";
}

enum class Twin { restarts_from_the_image, goes_on_from_its_own };

// From a micrometre to steps that slacken the cable, and now and then none at all.
double random_step_m(test::RandomWalk& walk) {
    const double exponent = -4.2 + 1.8 * walk.draw();
    return walk.draw() < -0.9 ? 0.0 : std::pow(10.0, exponent);
}

class Mirror : public testing::TestWithParam<InputPair> {
  protected:
    // Straight pieces and two bends of different radius, with stiction.
    CableSpecification specification = test::routed_specification(13);
    QuasiStaticStep step{Cable(specification), ModelRules::consistent()};
    QuasiStaticStep mirrored_step{Cable(test::mirrored(specification)), ModelRules::consistent()};

    Apart walk_together(int steps, Twin how) const {
        test::RandomWalk walk(step.cable(), GetParam(), 1e-4, 3);
        std::set<MotionKind> kinds;
        Apart most;
        CableState state = pretensioned(step.cable());
        CableState twin = test::mirrored(state);
        for (int k = 0; k < steps; ++k) {
            const bool lost = !test::moderately_stretched(state) && walk.draw() > 0.8;
            if (lost || k % 50 == 0) state = test::random_state(step, k);
            if (lost || k % 50 == 0 || how == Twin::restarts_from_the_image) twin = test::mirrored(state);
            walk.set_step_m(random_step_m(walk));
            const EndConditions ends = walk.next(state);
            const StepReport report = step.advance(state, ends);
            const StepReport twin_report = mirrored_step.advance(twin, test::mirrored(ends));
            kinds.insert(report.pattern.kind);
            EXPECT_EQ(report.verified, twin_report.verified) << "step " << k;
            EXPECT_TRUE(same_motion(report.pattern, test::mirrored(twin_report.pattern))) << "step " << k;
            most.widen(apart(state, test::mirrored(twin)));
        }
        // The walk keeps a prescribed tension above 0, and with it the cable taut.
        EXPECT_EQ(kinds.size(), test::prescribes_a_tension(GetParam()) ? 4u : 5u) << "kinds of motion met";
        tell(most);
        return most;
    }
};

// A tension comes of the difference of two displacements that are hundreds of times as large, so its last
// bits are some tens of ulp. What is asked for leaves a digit to spare.
constexpr double last_bits = 1e-13;
constexpr double last_bits_of_fifty_steps = 1e-12;

TEST_P(Mirror, SwappingTheEndsMirrorsEveryStepToTheLastBits) {
    const Apart most = walk_together(20000, Twin::restarts_from_the_image);
    EXPECT_LT(most.tension, last_bits);
    EXPECT_LT(most.displacement, last_bits);
}

TEST_P(Mirror, TwinsThatGoOnFromTheirOwnStatesStayTogether) {
    const Apart most = walk_together(20000, Twin::goes_on_from_its_own);
    EXPECT_LT(most.tension, last_bits_of_fifty_steps);
    EXPECT_LT(most.displacement, last_bits_of_fifty_steps);
}

INSTANTIATE_TEST_SUITE_P(EveryInputPair, Mirror, testing::ValuesIn(test::every_input_pair()),
                         [](const auto& which) { return test::name_of(which.param); });

}  // namespace
}  // namespace capstan
