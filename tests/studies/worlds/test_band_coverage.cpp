// How often the estimator's 95% band holds the true tension, on the configurations that are shipped as they
// are.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "capstan/config/config_reader.h"
#include "capstan/worlds/band_coverage.h"
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
