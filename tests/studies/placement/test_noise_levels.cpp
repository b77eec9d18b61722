// Noise levels read the same draws, so that what differs between them is the noise alone.
#include <gtest/gtest.h>

#include "capstan/placement/fusion_stage.h"
#include "paper_plan.h"

namespace capstan {
namespace {

// Known-direction errors of all sensor sets in mass motion, noise level by noise level.
std::vector<std::vector<double>> known_direction_errors_N(const std::vector<NamedNoise>& levels) {
    StudyPlan plan = test::paper_plan(100);
    plan.regimes = {{Regime::mass, {112, 142}, 1.0}};
    plan.fusion_methods = {"mean_known"};
    plan.noise_levels = levels;
    const PreparedStudy study = prepare(plan);
    const std::vector<double> weight(study.nodes(), 1.0);
    std::vector<std::vector<double>> errors_N;
    for (int noise = 0; noise < static_cast<int>(levels.size()); ++noise) {
        errors_N.emplace_back();
        for (int scenario = 0; scenario < 2; ++scenario) {
            const StudyPoint point{scenario, noise};
            double unused_s = 0.0;
            FusionTimes unused;
            const SolvedReadings solved = solve_readings(study, point, 1, unused_s);
            for (const auto& cell : fuse_readings(study, point, solved, weight, 1, unused).cells) {
                errors_N.back().push_back(cell.mean_abs_error_N);
            }
        }
    }
    return errors_N;
}

TEST(NoiseLevels, NoErrorWithoutNoiseWhenTheDirectionIsKnown) {
    const auto errors_N = known_direction_errors_N({{"none", {}}});
    for (const double error_N : errors_N[0]) EXPECT_LT(error_N, 1e-12);
}

TEST(NoiseLevels, ErrorsAreProportionalToTheNoiseOnTheSameDraws) {
    const auto errors_N = known_direction_errors_N(
        {{"1 %", {0.01, 0, 0}}, {"10 %", {0.1, 0, 0}}, {"little", {0, 0.01, 0}}, {"more", {0, 0.03, 0}}});
    for (std::size_t cell = 0; cell < errors_N[0].size(); ++cell) {
        EXPECT_NEAR(errors_N[1][cell] / errors_N[0][cell], 10.0, 1e-9);
        EXPECT_NEAR(errors_N[3][cell] / errors_N[2][cell], 3.0, 1e-9);
    }
}

TEST(NoiseLevels, OneLevelHasTheSameBitsInAStudyOfMany) {
    const NamedNoise ten{"10 %", {0.1, 0, 0}};
    EXPECT_EQ(known_direction_errors_N({ten})[0], known_direction_errors_N({{"1 %", {0.01, 0, 0}}, ten})[1]);
}

}  // namespace
}  // namespace capstan
