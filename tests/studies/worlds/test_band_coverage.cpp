// How often the estimator's 95% band holds the true tension, on the configurations that are shipped as they
// are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "capstan/config/config_reader.h"
#include "capstan/worlds/band_coverage.h"
#include "random_plans.h"
#include "world_plans.h"

namespace capstan {
namespace {

// As capstan bands prints it. Of so many sets one in fifty may be beyond by chance.
TEST(SlowBandCoverage, Is93To97PercentWithTheSetsOfEveryShippedConfiguration) {
    int configurations = 0;
    int sets = 0;
    int exceptions = 0;
    for (const auto& entry : std::filesystem::directory_iterator(CONFIGS_FOLDER)) {
        const std::string name = entry.path().filename().string();
        if (entry.path().extension() != ".toml" || name.starts_with("bench-")) continue;
        const StudyPlan plan = config::read_config(entry.path().string()).plan;
        if (!plan.uncertainty.is_stated) continue;
        ++configurations;
        ErrorTable table(plan, {});
        double mean = 0.0;
        double wider = 0.0;
        const std::vector<BandCoverage> bands = band_coverage(table, 150);
        for (const BandCoverage& band : bands) {
            const Candidate& set = table.candidates()[static_cast<std::size_t>(band.candidate)];
            ++sets;
            if (band.as_stated.is_exception()) {
                ++exceptions;
                std::printf("%s, %s: %.1f%%\n", name.c_str(), words_of(set, table.offers()).c_str(),
                            100.0 * band.as_stated.value);
            }
            EXPECT_LT(band.wider.value, band.as_stated.value);
            mean += band.as_stated.value / static_cast<double>(bands.size());
            wider += band.wider.value / static_cast<double>(bands.size());
        }
        std::printf("%s: %.1f%% in the mean over the sets, in worlds twice as uncertain %.1f%%\n",
                    name.c_str(), 100.0 * mean, 100.0 * wider);
        EXPECT_GT(mean, 0.935) << name;
        EXPECT_LT(mean, 0.965) << name;
    }
    EXPECT_GE(configurations, 5);
    EXPECT_LE(exceptions, sets / 50);
}

struct RandomCoverage {
    int sets = 0;
    int exceptions = 0;
    double mean = 0.0;
};

// The plans' numbers are their seeds.
RandomCoverage coverage_of_random_cables(unsigned first, bool sticks) {
    constexpr unsigned cables = 20;
    constexpr int worlds = 60;
    RandomCoverage all;
    for (unsigned number = first; number < first + cables; ++number) {
        StudyPlan plan = testing::random_plan(number);
        CableSpecification& cable = plan.transmission.cable;
        if (!sticks) cable.static_friction = cable.dynamic_friction;
        ErrorTable table(plan, {});
        const std::vector<BandCoverage> bands = band_coverage(table, worlds);
        double mean = 0.0;
        double wider = 0.0;
        double least = 1.0;
        double most = 0.0;
        int exceptions = 0;
        for (const BandCoverage& band : bands) {
            exceptions += band.as_stated.is_exception() ? 1 : 0;
            mean += band.as_stated.value / static_cast<double>(bands.size());
            wider += band.wider.value / static_cast<double>(bands.size());
            least = std::min(least, band.as_stated.value);
            most = std::max(most, band.as_stated.value);
        }
        std::printf(
            "%s, friction %.2f and %.2f at rest: %.1f%% in the mean over %zu sets (%.1f to %.1f%%), %d beyond; in "
            "worlds twice as uncertain %.1f%%\n",
            plan.name.c_str(), cable.dynamic_friction, cable.static_friction, 100.0 * mean, bands.size(),
            100.0 * least, 100.0 * most, exceptions, 100.0 * wider);
        all.sets += static_cast<int>(bands.size());
        all.exceptions += exceptions;
        all.mean += mean / cables;
    }
    std::printf("all: %.1f%%; %d of %d sets beyond 93 to 97%% by two standard errors\n", 100.0 * all.mean,
                all.exceptions, all.sets);
    return all;
}

// Cables that had no part in the development of the filter.
TEST(SlowBandCoverage, Is93To97PercentOnTwentyRandomCablesThatDoNotStick) {
    const RandomCoverage all = coverage_of_random_cables(401, false);
    EXPECT_GT(all.mean, 0.935);
    EXPECT_LT(all.mean, 0.965);
    EXPECT_LE(all.exceptions, all.sets / 20);
}

// With static friction up to twice the dynamic one a segment sticks or slides, which no normal belief says.
TEST(SlowBandCoverage, IsSmallerOnSomeRandomCablesThatStick) {
    const RandomCoverage all = coverage_of_random_cables(301, true);
    EXPECT_GT(all.mean, 0.93);
    EXPECT_LT(all.mean, 0.965);
    EXPECT_LE(all.exceptions, all.sets / 8);
}

TEST(BandCoverage, OfAWorldTwiceAsUncertainIsSmaller) {
    ErrorTable table(testing::small_plan(3, 10), {});
    const std::vector<BandCoverage> bands = band_coverage(table, 40);
    ASSERT_EQ(bands.size(), table.candidates().size());
    double as_stated = 0.0;
    double wider = 0.0;
    for (const BandCoverage& band : bands) {
        EXPECT_GT(band.as_stated.standard_error, 0.0);
        as_stated += band.as_stated.value / static_cast<double>(bands.size());
        wider += band.wider.value / static_cast<double>(bands.size());
    }
    EXPECT_GT(as_stated, 0.9);
    EXPECT_LT(wider, as_stated - 0.05);
}

TEST(BandCoverage, IsAnExceptionOnlyBeyondTwoStandardErrors) {
    EXPECT_FALSE((CoveredFraction{0.92, 0.006}.is_exception()));
    EXPECT_TRUE((CoveredFraction{0.92, 0.004}.is_exception()));
    EXPECT_FALSE((CoveredFraction{0.95, 0.0}.is_exception()));
    EXPECT_TRUE((CoveredFraction{0.98, 0.002}.is_exception()));
}

}  // namespace
}  // namespace capstan
