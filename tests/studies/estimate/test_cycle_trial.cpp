#include <gtest/gtest.h>

#include "capstan/estimate/cycle_trial.h"

namespace capstan::estimate {
namespace {

// The paper's experiment, over a complete cycle instead of at two instants.
StudyPlan paper_cycle() {
    StudyPlan plan;
    plan.name = "cycle";
    plan.transmission.cable = {{{2.0, 0.28}}, 10, 2000.0, 0.21, 0.63, 10.0};
    plan.motion.proximal = {EndKind::position, 0.01, 1.0, 0.0, 0.0, 1e9, 0.0};
    plan.motion.sample_rate_Hz = 100.0;
    plan.motion.samples = 150;
    plan.noise_levels = {{"10%", {0.1, 0.0, 0.0}}};
    plan.layout_families = {"distal"};
    plan.sensor_counts = {1, 3};
    plan.largest_distal_increment_m = 6.3e-4;
    return plan;
}

TEST(CycleTrial, TheRecursiveEstimatorHasASmallerErrorThanThePapers) {
    CycleOptions options;
    options.repetitions = 6;
    for (const CycleScore& score : score_cycles(paper_cycle(), options)) {
        EXPECT_LT(score.error_N, 0.3 * score.paper_mean_N);
        EXPECT_LT(score.error_N, 0.3 * score.paper_mean_r_N);
        // A held far end is not drawn from a wander; where it is, 93 to 97 are promised (RecursiveEstimator).
        EXPECT_GE(score.coverage, 0.90);
    }
}

TEST(CycleTrial, ThreadsChangeNoBit) {
    CycleOptions options;
    options.repetitions = 2;
    const auto alone = score_cycles(paper_cycle(), options);
    options.jobs = 2;
    const auto together = score_cycles(paper_cycle(), options);
    for (std::size_t k = 0; k < alone.size(); ++k) {
        EXPECT_EQ(alone[k].error_N, together[k].error_N);
        EXPECT_EQ(alone[k].paper_mean_N, together[k].paper_mean_N);
    }
}

}  // namespace
}  // namespace capstan::estimate
