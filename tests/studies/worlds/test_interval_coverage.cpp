// What a study says of the error to expect, against what many worlds say.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "capstan/platform/parallel_for.h"
#include "capstan/worlds/choice.h"
#include "world_plans.h"

namespace capstan {
namespace {

using testing::small_plan;

void expect_that_intervals_cover(int studies, int many) {
    ErrorTable reference(small_plan(1000000, many), {});
    std::vector<int> all;
    for (int k = 0; k < static_cast<int>(reference.candidates().size()); ++k) all.push_back(k);
    reference.fill(Condition::as_stated, all, 0, many, "test");
    const auto truth_N = [&](int candidate) {
        double mean_N = 0.0;
        for (int w = 0; w < many; ++w)
            mean_N += reference.at(Condition::as_stated, candidate, w).mean_abs_N / many;
        return mean_N;
    };
    std::vector<Expected> recommended(static_cast<std::size_t>(studies));
    parallel_for_each_index(studies, 0, [&](int k) {
        ErrorTable table(small_plan(5000 + static_cast<std::uint64_t>(k), 40), {.jobs = 1});
        Choice choice(table);
        const WorldAnswer answer = choose_of_each_price(choice);
        recommended[static_cast<std::size_t>(k)] = answer.best().expected;
    });
    int held = 0;
    int worse_than_none = 0;
    std::map<int, int> chosen;
    for (const Expected& each : recommended) {
        const double value_N = truth_N(each.candidate);
        held += each.objective.low_N <= value_N && value_N <= each.objective.high_N ? 1 : 0;
        worse_than_none += value_N >= truth_N(0) ? 1 : 0;
        ++chosen[each.candidate];
    }
    std::printf("%d small studies: the 95%% interval held the expected error in %.1f%%; %zu different sets\n",
                studies, 100.0 * held / studies, chosen.size());
    const double three_deviations = 3.0 * std::sqrt(0.95 * 0.05 / studies);
    EXPECT_GT(held, (0.95 - three_deviations) * studies);
    EXPECT_LT(held, (0.95 + three_deviations) * studies);
    EXPECT_EQ(worse_than_none, 0);
}

// Of so few studies only an interval that is too narrow shows.
TEST(IntervalCoverage, TheMonteCarloIntervalHoldsTheExpectedErrorAboutAsOftenAsItSays) {
    expect_that_intervals_cover(60, 1000);
}

TEST(SlowIntervalCoverage, TheMonteCarloIntervalHoldsTheExpectedErrorAsOftenAsItSays) {
    expect_that_intervals_cover(400, 3000);
}

}  // namespace
}  // namespace capstan
