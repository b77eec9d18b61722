#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "capstan/cable/cable_cut.h"
#include "capstan/cable/cable_state.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/cable_paths/cable_paths.h"
#include "capstan/platform/stop_request.h"
#include "capstan/solver/quasi_static_step.h"

namespace capstan {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

CableSpecification bent_cable() {
    return {.curvature = {{.length_m = 0.5}, {.length_m = 0.5, .bend_radius_m = 0.3}, {.length_m = 0.2}},
            .segments = 12,
            .axial_stiffness_N = 5000.0,
            .dynamic_friction = 0.15,
            .static_friction = 0.18,
            .pretension_N = 20.0};
}

std::vector<double> to_and_fro_m() {
    std::vector<double> motor_m;
    for (int time = 0; time < 200; ++time) motor_m.push_back(0.01 * std::sin(0.05 * time));
    return motor_m;
}

struct Paths {
    std::size_t times, nodes;
    std::vector<double> tension_N, displacement_m;
    PathReport report;

    double tension_at_N(std::size_t draw, std::size_t time, std::size_t node) const {
        return tension_N[(draw * times + time) * nodes + node];
    }
};

Paths simulated(const CableSpecification& specification, const CableMotion& motion, const CableDraws& draws,
                int jobs = 1) {
    const Cable cable(specification);
    Paths paths{motion.motor_m.size(), static_cast<std::size_t>(cable.nodes()), {}, {}, {}};
    paths.tension_N.resize(static_cast<std::size_t>(count_of(draws)) * paths.times * paths.nodes);
    paths.displacement_m.resize(paths.tension_N.size());
    paths.report = simulate_paths(cable, motion, draws, jobs, {paths.tension_N, paths.displacement_m});
    return paths;
}

TEST(CablePaths, EachDrawIsWhatSingleStepsOfItsOwnCableGive) {
    const CableMotion motion{to_and_fro_m(), SpringLoad{3000.0}};
    const CableDraws draws{{0.05, 0.15, 0.3}, {4000.0, 5000.0, 6000.0}, {10.0, 20.0, 30.0}};
    const Paths paths = simulated(bent_cable(), motion, draws);
    for (std::size_t draw = 0; draw < 3; ++draw) {
        CableSpecification own = bent_cable();
        own.dynamic_friction = draws.friction[draw];
        own.static_friction = 1.2 * draws.friction[draw];
        own.axial_stiffness_N = draws.axial_stiffness_N[draw];
        own.pretension_N = draws.pretension_N[draw];
        const QuasiStaticStep step(Cable(own), ModelRules::consistent());
        CableState state = pretensioned(step.cable());
        const double rest_m = state.displacement_m.front();
        for (std::size_t time = 0; time < paths.times; ++time) {
            step.advance(state, {EndCondition::position_m(rest_m - motion.motor_m[time]),
                                 distal_spring({3000.0, own.pretension_N, 0.0})});
            for (std::size_t node = 0; node < paths.nodes; ++node)
                ASSERT_NEAR(paths.tension_at_N(draw, time, node), state.tension_N[node], 1e-6)
                    << "draw " << draw << ", time " << time << ", node " << node;
        }
    }
}

TEST(CablePaths, ADrawDependsNeitherOnOthersNorOnThreads) {
    const CableMotion motion{to_and_fro_m(), BlockedLoad{}};
    CableDraws many;
    for (int draw = 0; draw < 21; ++draw) many.friction.push_back(0.02 * draw);
    const Paths together = simulated(bent_cable(), motion, many, 2);
    const Paths one_thread = simulated(bent_cable(), motion, many, 1);
    EXPECT_EQ(together.tension_N, one_thread.tension_N);
    const Paths alone = simulated(bent_cable(), motion, {{many.friction[17]}, {}, {}});
    for (std::size_t time = 0; time < alone.times; ++time)
        for (std::size_t node = 0; node < alone.nodes; ++node)
            ASSERT_EQ(alone.tension_at_N(0, time, node), together.tension_at_N(17, time, node));
}

TEST(CablePaths, WithoutFrictionEveryNodePullsAsTheSpringDoes) {
    const double reeled_in_m = 0.01;
    CableSpecification cable = bent_cable();
    cable.dynamic_friction = cable.static_friction = 0.0;
    const Paths paths = simulated(cable, {{reeled_in_m}, SpringLoad{3000.0}}, {});
    const double cable_N_per_m = cable.axial_stiffness_N / length_m(cable.curvature);
    const double both_N_per_m = 1.0 / (1.0 / 3000.0 + 1.0 / cable_N_per_m);
    for (std::size_t node = 0; node < paths.nodes; ++node)
        EXPECT_NEAR(paths.tension_at_N(0, 0, node), cable.pretension_N + both_N_per_m * reeled_in_m, 1e-9);
}

TEST(CablePaths, AWeightPullsTheLoadEndAndAMovedLoadStretchesTheCable) {
    const Paths weight = simulated(bent_cable(), {to_and_fro_m(), WeightLoad{25.0}}, {});
    for (std::size_t time = 0; time < weight.times; ++time)
        ASSERT_NEAR(weight.tension_at_N(0, time, weight.nodes - 1), 25.0, 1e-9);
    const Paths moved = simulated(bent_cable(), {{0.0, 0.0}, MovedLoad{{0.002, 0.004}}}, {});
    EXPECT_GT(moved.tension_at_N(0, 0, moved.nodes - 1), 20.0);
    EXPECT_GT(moved.tension_at_N(0, 1, moved.nodes - 1), moved.tension_at_N(0, 0, moved.nodes - 1));
}

TEST(CablePaths, AReleasedCableGoesSlackAndNeverPushes) {
    const Paths paths = simulated(bent_cable(), {{0.0, -0.05, -0.1, 0.01}, BlockedLoad{}}, {});
    for (const double tension_N : paths.tension_N) EXPECT_GE(tension_N, 0.0);
    EXPECT_EQ(paths.tension_at_N(0, 2, 3), 0.0);
    EXPECT_GT(paths.tension_at_N(0, 3, 0), 20.0);
}

TEST(CablePaths, ListsEveryProblem) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    try {
        simulated(bent_cable(), {{0.0, nan}, SpringLoad{-1.0}}, {{0.1, -0.1, -0.2}, {5000.0}, {}});
        FAIL() << "nothing was refused";
    } catch (const InvalidInput& refused) {
        EXPECT_THAT(
            refused.problems(),
            ElementsAre(HasSubstr("motor_m[1]: is nan"), HasSubstr("load.stiffness_N_per_m: is -1"),
                        HasSubstr("friction[1]: is -0.1"), HasSubstr("axial_stiffness_N: has 1 draws")));
    }
}

TEST(CablePaths, StopsWhenItsWorkIsNoLongerWanted) {
    const std::atomic<bool> stop{true};
    const StopScope scope(&stop);
    EXPECT_THROW(simulated(bent_cable(), {to_and_fro_m(), BlockedLoad{}}, {}), WorkStopped);
}

}  // namespace
}  // namespace capstan
