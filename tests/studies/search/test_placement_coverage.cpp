// 400 independent small studies against the errors that 40,000 repetitions give: what "95%" means has to be
// true. The seeds are fixed, and so are the counts; a fraction of 95% of 400 has a standard deviation
// of 1.1%.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "capstan/platform/parallel_for.h"
#include "capstan/search/sensor_placement.h"
#include "every_layout.h"

namespace capstan {
namespace {

using test::EveryLayout;

using test::coverage_studies;
using test::Tally;

// Without W methods: their weights come from each study's own draws, so each study has a truth of its own.
StudyPlan placed_plan(int repetitions, std::uint64_t seed) {
    StudyPlan plan = test::short_cable_plan(repetitions, seed);
    plan.fusion_methods = {"mean", "mean_r", "maximum_likelihood", "posterior_mean"};
    return plan;
}

class Coverage : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        truth_plan = new StudyPlan(placed_plan(40000, 987654321));
        truth = new EveryLayout(*truth_plan, 0, 0);
        truth->draws.extend({40000, 1000}, truth->weights, 0);
        answers = new std::vector<PlacementAnswer>(coverage_studies);
        parallel_for_each_index(coverage_studies, 0, [](int k) {
            PlacementOptions options;
            options.jobs = 1;
            (*answers)[k] = place_sensors(placed_plan(200, 1000 + k), options);
        });
    }
    static void TearDownTestSuite() {
        delete answers;
        delete truth;
        delete truth_plan;
    }

    static double true_error_N(const ScopeAnswer& scope, const std::vector<int>& nodes,
                               const std::string& method) {
        const int candidate = truth->candidate(nodes, method);
        double error_N = 0.0;
        for (std::size_t s = 0; s < truth->study.scenarios.size(); ++s) {
            const bool counts =
                scope.scope == "duty_cycle" || name_of(truth->study.scenarios[s].regime) == scope.regime;
            if (counts)
                error_N += (scope.scope == "duty_cycle" ? 0.5 : 1.0) *
                           truth->draws.scenarios()[s].error_N[candidate];
        }
        return error_N;
    }
    /// Regrets have no fixed truth: what they are measured from is chosen by each study.
    template <class Visit>
    static void for_each_count(const Visit& visit) {
        for (const PlacementAnswer& answer : *answers) {
            for (const ScopeAnswer& scope : answer.scopes) {
                if (scope.scope == "minimax_regret") continue;
                for (const CountAnswer& count : scope.counts) visit(scope, count);
            }
        }
    }

    static StudyPlan* truth_plan;
    static EveryLayout* truth;
    static std::vector<PlacementAnswer>* answers;
};
StudyPlan* Coverage::truth_plan = nullptr;
EveryLayout* Coverage::truth = nullptr;
std::vector<PlacementAnswer>* Coverage::answers = nullptr;

// This includes the optimum, although it was selected by its error: its interval is that of the independent
// draws.
TEST_F(Coverage, IntervalsCoverTheTruth93To97Percent) {
    std::map<std::string, Tally> tallies;
    for_each_count([&](const ScopeAnswer& scope, const CountAnswer& count) {
        const auto look = [&](const JudgedLayout& layout) {
            Tally& tally = tallies[layout.how == "optimum" ? "optimum" : "others"];
            const double error_N = true_error_N(scope, layout.nodes, layout.method);
            tally.covered += layout.independent.low_N <= error_N && error_N <= layout.independent.high_N;
            ++tally.all;
        };
        look(count.optimum);
        for (const JudgedLayout& layout : count.runners_up) look(layout);
        for (const JudgedLayout& layout : count.beside) look(layout);
    });
    for (const auto& [how, tally] : tallies) {
        EXPECT_GE(tally.fraction(), 0.93) << how;
        EXPECT_LE(tally.fraction(), 0.97) << how;
        EXPECT_GE(tally.all, 10 * coverage_studies) << how;
        RecordProperty(how, std::to_string(tally.fraction()));
    }
}

TEST_F(Coverage, PairedDifferencesToTheOptimumCoverTheTruth93To97Percent) {
    Tally tally;
    for_each_count([&](const ScopeAnswer& scope, const CountAnswer& count) {
        const double best_N = true_error_N(scope, count.optimum.nodes, count.optimum.method);
        for (const JudgedLayout& layout : count.runners_up) {
            const double difference_N = true_error_N(scope, layout.nodes, layout.method) - best_N;
            tally.covered +=
                layout.difference.low_N <= difference_N && difference_N <= layout.difference.high_N;
            ++tally.all;
        }
    });
    EXPECT_GE(tally.fraction(), 0.93);
    EXPECT_LE(tally.fraction(), 0.97);
}

TEST_F(Coverage, IndifferentSetContainsTheTrulyBestAtLeast95PercentOfTheTime) {
    std::map<std::string, Tally> tallies;
    std::map<std::string, std::pair<std::vector<int>, std::string>> best;
    for_each_count([&](const ScopeAnswer& scope, const CountAnswer& count) {
        const std::string question = scope.scope + " " + scope.regime + " " + std::to_string(count.sensors);
        if (best.count(question) == 0) {
            double best_N = 1e9;
            for (int c = truth->candidates.of(1, 0); c < truth->candidates.count(); ++c) {
                const std::vector<int> nodes = truth->subsets.nodes_of(truth->candidates.subset(c));
                const std::string method(truth->candidates.methods[truth->candidates.method(c)]->name);
                if (static_cast<int>(nodes.size()) != count.sensors) continue;
                const double error_N = true_error_N(scope, nodes, method);
                if (error_N >= best_N) continue;
                best_N = error_N;
                best[question] = {nodes, method};
            }
        }
        const auto& [nodes, method] = best[question];
        const bool is_optimum = count.optimum.nodes == nodes && count.optimum.method == method;
        Tally& tally = tallies[question];
        tally.covered +=
            is_optimum || std::any_of(count.indifferent.begin(), count.indifferent.end(),
                                      [&, &n = nodes, &m = method](const IndifferentLayout& other) {
                                          return other.nodes == n && other.method == m;
                                      });
        ++tally.all;
    });
    EXPECT_EQ(tallies.size(), 15u);  // two regimes and the duty cycle, 1 to 5 sensors
    for (const auto& [question, tally] : tallies) {
        EXPECT_GE(tally.fraction(), 0.95) << question;
        EXPECT_EQ(tally.all, coverage_studies);
    }
}

// An indifferent set that holds everything would pass the test above.
TEST_F(Coverage, IndifferentSetExcludesClearlyWorseLayouts) {
    Tally left_out;
    for_each_count([&](const ScopeAnswer& scope, const CountAnswer& count) {
        if (scope.scope != "duty_cycle" || count.sensors != 2) return;
        left_out.covered += static_cast<int>(count.indifferent.size());
        left_out.all += 4 * count.allowed_layouts - 1;
    });
    EXPECT_LT(left_out.fraction(), 0.75);
}

}  // namespace
}  // namespace capstan
