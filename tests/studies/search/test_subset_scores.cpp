#include <gtest/gtest.h>

#include "capstan/placement/fusion_stage.h"
#include "every_layout.h"

namespace capstan {
namespace {

using test::EveryLayout;

// Sets of all sizes, the same every time: every k-th of the 2047.
std::vector<std::vector<int>> some_layouts() {
    std::vector<std::vector<int>> layouts;
    for (unsigned bits = 1; bits < 2048; bits += 23) {
        layouts.emplace_back();
        for (int node = 0; node < 11; ++node) {
            if (bits >> node & 1) layouts.back().push_back(node);
        }
    }
    return layouts;
}

struct Judged {
    const char* name;
    PlacementObjective objective;
    double (*of_cell)(const storage::CellRecord&);
    double tolerance_N;
};

class SubsetScores : public testing::TestWithParam<Judged> {};

// The study fuses each set by itself; the search reuses the sums of smaller sets. Tension errors are newtons
// and sums a few dozen terms, so 1e-12 N is their rounding; repetitions' errors behind a quantile are kept as
// float.
TEST_P(SubsetScores, EveryLayoutHasTheErrorOfAStudy) {
    StudyPlan plan = test::paper_plan(75);  // the last block is shorter
    plan.noise_levels.push_back({"all kinds", {0.05, 0.2, 0.1}});
    plan.layout_families.clear();
    plan.explicit_layouts = some_layouts();
    plan.placement.objective = GetParam().objective;
    for (int noise = 0; noise < 2; ++noise) {
        EveryLayout every(plan, noise);
        every.draws.extend(DrawBlocks::for_repetitions(75), every.weights, 1);
        for (int s = 0; s < static_cast<int>(every.study.scenarios.size()); ++s) {
            double processor_time_s = 0.0;
            FusionTimes times;
            const SolvedReadings solved = solve_readings(every.study, {s, noise}, 1, processor_time_s);
            const auto result = fuse_readings(every.study, {s, noise}, solved, every.weights[s], 1, times);
            int compared = 0;
            for (const storage::CellRecord& cell : result.cells) {
                const int candidate = every.candidate(every.study.sensor_sets[cell.set_index], cell.method);
                if (candidate < 0) continue;  // told the direction
                EXPECT_NEAR(every.draws.scenarios()[s].error_N[candidate], GetParam().of_cell(cell),
                            GetParam().tolerance_N)
                    << cell.method << " " << nodes_as_people_count(every.study.sensor_sets[cell.set_index]);
                ++compared;
            }
            EXPECT_EQ(compared, 6 * static_cast<int>(plan.explicit_layouts.size()));
        }
    }
}

// A method without an Averaging is fused set by set: each paper's method must then have the same errors.
TEST(SubsetMeans, AMethodWithoutSumsHasTheErrorsOfItsOwnFuse) {
    StudyPlan plan = test::short_cable_plan(40);
    EveryLayout every(plan);
    std::vector<FusionMethod> slow;
    for (const FusionMethod* method : every.candidates.methods) {
        if (!method->averaging) continue;
        slow.push_back(*method);
        slow.back().averaging.reset();
    }
    ASSERT_EQ(slow.size(), 4u);
    CandidateList one_by_one{every.subsets, {}, {}};
    for (const FusionMethod& method : slow) one_by_one.methods.push_back(&method);
    ScoredDraws draws(every.study, 0, 0, one_by_one, plan.placement.objective);
    draws.extend({40, 2}, every.weights, 1);
    every.draws.extend({40, 2}, every.weights, 1);
    for (std::size_t scenario = 0; scenario < every.study.scenarios.size(); ++scenario) {
        for (int subset = 1; subset < every.subsets.count(); ++subset) {
            for (int m = 0; m < 4; ++m) {
                const int fast = every.candidate(every.subsets.nodes_of(subset), slow[m].name);
                EXPECT_NEAR(draws.scenarios()[scenario].error_N[one_by_one.of(subset, m)],
                            every.draws.scenarios()[scenario].error_N[fast], 1e-12)
                    << slow[m].name << " " << subset;
            }
        }
    }
}

TEST(SubsetMeans, RefusesAMethodThatMustKnowTheDirection) {
    StudyPlan plan = test::short_cable_plan(4);
    EveryLayout every(plan);
    const CandidateList known{every.subsets, {&mean_known_direction}, {}};
    ScoredDraws draws(every.study, 0, 0, known, plan.placement.objective);
    EXPECT_THROW(draws.extend({4, 2}, every.weights, 1), std::logic_error);
}

INSTANTIATE_TEST_SUITE_P(
    Objectives, SubsetScores,
    testing::Values(Judged{"AllNodes", PlacementObjective::all_nodes,
                           [](const storage::CellRecord& cell) { return cell.mean_abs_error_N; }, 1e-12},
                    Judged{"LoadEnd", PlacementObjective::load_end,
                           [](const storage::CellRecord& cell) { return cell.nodes.back().mean_abs_error_N; },
                           1e-12},
                    Judged{"WorstNode", PlacementObjective::worst_node,
                           [](const storage::CellRecord& cell) { return cell.worst_node_error_N; }, 1e-12},
                    Judged{"Quantile95", PlacementObjective::quantile_95,
                           [](const storage::CellRecord& cell) { return cell.error_q95_N; }, 1e-6}),
    [](const auto& each) { return each.param.name; });

TEST(ScoredDraws, MoreRepetitionsKeepTheFirstOnes) {
    const StudyPlan plan = test::short_cable_plan(40);
    EveryLayout twice(plan);
    EveryLayout once(plan);
    twice.draws.extend({20, 2}, twice.weights, 1);
    const std::vector<ScenarioErrors> first = twice.draws.scenarios();
    twice.draws.extend({40, 2}, twice.weights, 1);
    once.draws.extend({40, 2}, once.weights, 1);
    for (std::size_t s = 0; s < first.size(); ++s) {
        EXPECT_EQ(twice.draws.scenarios()[s].block_error_N, once.draws.scenarios()[s].block_error_N);
        for (int c = once.candidates.of(1, 0); c < once.candidates.count(); ++c) {
            for (int b = 0; b < 10; ++b)
                EXPECT_EQ(once.draws.scenarios()[s].blocks_of(c)[b], first[s].blocks_of(c)[b]);
        }
    }
}

TEST(ScoredDraws, AnyNumberOfThreadsGivesTheSameBits) {
    const StudyPlan plan = test::short_cable_plan(60);
    std::vector<std::vector<double>> errors_N;
    for (const int jobs : {1, 2, 7, 16}) {
        EveryLayout every(plan, 0, jobs);
        every.draws.extend({60, 2}, every.weights, jobs);
        errors_N.emplace_back();
        for (const ScenarioErrors& scenario : every.draws.scenarios()) {
            errors_N.back().insert(errors_N.back().end(), scenario.block_error_N.begin(),
                                   scenario.block_error_N.end());
        }
    }
    EXPECT_EQ(errors_N[0], errors_N[1]);
    EXPECT_EQ(errors_N[0], errors_N[2]);
}

TEST(ScoredDraws, UnwantedCandidatesDoNotChangeTheOthers) {
    const StudyPlan plan = test::short_cable_plan(20);
    EveryLayout all(plan);
    EveryLayout few(plan);
    few.candidates.wanted.assign(few.candidates.count(), 0);
    std::vector<int> wanted = {few.candidate({1, 3}, "mean_r"), few.candidate({0, 2, 4}, "posterior_mean"),
                               few.candidate({4}, "maximum_likelihood"),
                               few.candidate({0, 1, 4}, "w_mean_r")};
    for (const int candidate : wanted) few.candidates.wanted[candidate] = 1;
    all.draws.extend({20, 2}, all.weights, 1);
    few.draws.extend({20, 2}, few.weights, 1);
    for (std::size_t s = 0; s < all.draws.scenarios().size(); ++s) {
        for (const int candidate : wanted) {
            EXPECT_EQ(few.draws.scenarios()[s].error_N[candidate],
                      all.draws.scenarios()[s].error_N[candidate]);
        }
    }
}

}  // namespace
}  // namespace capstan
