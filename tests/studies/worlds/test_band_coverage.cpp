// How often the estimator's 95% band holds the true tension, on the configurations that are shipped as they
// are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "capstan/config/config_reader.h"
#include "capstan/worlds/error_table.h"

namespace capstan {
namespace {

struct Coverage {
    double least = 1.0;
    double most = 0.0;
    double mean = 0.0;
    int sets = 0;
    int exceptions = 0;
};

// Of every set that the study compares, over so many worlds. They leave about half a percent open, so that a
// set is an exception below 92% or above 98%.
Coverage coverage_of(const StudyPlan& plan, int worlds) {
    ErrorTable table(plan, {});
    Coverage coverage;
    coverage.sets = static_cast<int>(table.candidates().size());
    std::vector<int> all;
    for (int set = 0; set < coverage.sets; ++set) all.push_back(set);
    table.fill(Condition::as_stated, all, 0, worlds, "test");
    for (const int set : all) {
        double covered = 0.0;
        for (int world = 0; world < worlds; ++world)
            covered += table.at(Condition::as_stated, set, world).covered_fraction / worlds;
        coverage.least = std::min(coverage.least, covered);
        coverage.most = std::max(coverage.most, covered);
        coverage.mean += covered / coverage.sets;
        if (covered > 0.92 && covered < 0.98) continue;
        ++coverage.exceptions;
        const Candidate& candidate = table.candidates()[static_cast<std::size_t>(set)];
        std::printf("%s, %s: %.1f%%\n", plan.name.c_str(), words_of(candidate, table.offers()).c_str(),
                    100.0 * covered);
    }
    return coverage;
}

TEST(SlowBandCoverage, Is93To97PercentOnEveryShippedConfiguration) {
    int configurations = 0;
    int sets = 0;
    int exceptions = 0;
    for (const auto& entry : std::filesystem::directory_iterator(CONFIGS_FOLDER)) {
        const std::string name = entry.path().filename().string();
        if (entry.path().extension() != ".toml" || name.starts_with("bench-")) continue;
        const StudyPlan plan = config::read_config(entry.path().string()).plan;
        if (!plan.uncertainty.is_stated) continue;
        ++configurations;
        const Coverage coverage = coverage_of(plan, 150);
        std::printf("%s: %.1f%% in the mean over the sets, %.1f to %.1f%%\n", name.c_str(),
                    100.0 * coverage.mean, 100.0 * coverage.least, 100.0 * coverage.most);
        EXPECT_GT(coverage.mean, 0.93) << name;
        EXPECT_LT(coverage.mean, 0.97) << name;
        sets += coverage.sets;
        exceptions += coverage.exceptions;
    }
    EXPECT_GE(configurations, 5);
    EXPECT_LE(exceptions, sets / 50);
}

}  // namespace
}  // namespace capstan
