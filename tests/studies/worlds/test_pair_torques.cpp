// Torques at both pulleys of a pull-pull pair and no load cell: the band, and what it is about.
#include <gtest/gtest.h>

#include <cmath>

#include "capstan/platform/parallel_for.h"
#include "capstan/worlds/world_trial.h"
#include "world_plans.h"

namespace capstan {
namespace {

// Over worlds, samples and nodes. Common: half the sum of both cables' tensions; difference: half of that.
struct PairErrors {
    double covered_fraction = 0.0;
    double common_N = 0.0;
    double difference_N = 0.0;
};

StudyPlan torque_plan() {
    StudyPlan plan = testing::pair_plan();
    plan.sensors = {{SensorKind::motor_torque, {}, {0.02, 0.5, 0.0, 0.0}, 1.0},
                    {SensorKind::load_torque, {}, {0.01, 0.3, 0.0, 0.0}, 1.0}};
    return plan;
}

PairErrors errors_of(const StudyPlan& plan, const std::vector<int>& sensors, int worlds) {
    const WorldQuestion question = world_question(plan);
    std::vector<PairErrors> squares(static_cast<std::size_t>(worlds));
    parallel_for_each_index(worlds, 0, [&](int w) {
        const World world = draw_world(question, static_cast<std::uint32_t>(w));
        const EnsembleDraws draws = ensemble_draws(question, static_cast<std::uint32_t>(w));
        EnsembleFilter filter(question.cable, question.belief, question.offers, sensors, draws);
        PairErrors& sum = squares[static_cast<std::size_t>(w)];
        std::vector<double> readings;
        for (int sample = 0; sample < world.samples(); ++sample) {
            world.read(sample, question.offers, sensors, readings);
            filter.step(world.proximal_increment_m[static_cast<std::size_t>(sample)], readings);
            const auto truth_N = world.tensions_N(sample);
            const auto mean_N = filter.mean_N();
            const auto deviation_N = filter.deviation_N();
            const std::size_t nodes = truth_N.size() / 2;
            const double share = 1.0 / static_cast<double>(nodes * static_cast<std::size_t>(world.samples()));
            for (std::size_t node = 0; node < nodes; ++node) {
                const double of_a = mean_N[node] - truth_N[node];
                const double of_b = mean_N[node + nodes] - truth_N[node + nodes];
                sum.covered_fraction +=
                    0.5 * share *
                    ((std::abs(of_a) <= deviations_of_95 * deviation_N[node] ? 1.0 : 0.0) +
                     (std::abs(of_b) <= deviations_of_95 * deviation_N[node + nodes] ? 1.0 : 0.0));
                sum.common_N += share * 0.25 * (of_a + of_b) * (of_a + of_b);
                sum.difference_N += share * 0.25 * (of_a - of_b) * (of_a - of_b);
            }
        }
    });
    PairErrors mean;
    for (const PairErrors& each : squares) {
        mean.covered_fraction += each.covered_fraction / worlds;
        mean.common_N += each.common_N / worlds;
        mean.difference_N += each.difference_N / worlds;
    }
    for (double* square : {&mean.common_N, &mean.difference_N}) *square = std::sqrt(*square);
    return mean;
}

TEST(PairTorques, TheBandIsHonestAlthoughNoReadingTellsOfTheSumOfBothTensions) {
    double covered = 0.0;
    for (const std::uint64_t seed : {4, 5, 6}) {
        StudyPlan plan = torque_plan();
        plan.seed = seed;
        const PairErrors none = errors_of(plan, {}, 200);
        const PairErrors both = errors_of(plan, {0, 1}, 200);
        // Nearly all that remains is the sum, which pretension and friction decide.
        EXPECT_LT(both.difference_N, 0.1 * none.difference_N);
        EXPECT_GT(both.common_N, 0.6 * none.common_N);
        EXPECT_GT(both.common_N, 3.0 * both.difference_N);
        covered += both.covered_fraction / 3.0;
    }
    EXPECT_GT(covered, 0.93);
    EXPECT_LT(covered, 0.97);
}

// The sum is not observed, so that its error is that of what is believed, whatever the number of members.
TEST(PairTorques, MoreMembersGiveTheSameBandAndASmallerErrorOfTheDifference) {
    StudyPlan plan = torque_plan();
    const PairErrors few = errors_of(plan, {0, 1}, 150);
    plan.uncertainty.members = 256;
    const PairErrors many = errors_of(plan, {0, 1}, 150);
    EXPECT_NEAR(many.covered_fraction, few.covered_fraction, 0.02);
    EXPECT_LT(many.difference_N, few.difference_N);
    EXPECT_NEAR(many.common_N, few.common_N, 0.02 * few.common_N);
}

}  // namespace
}  // namespace capstan
