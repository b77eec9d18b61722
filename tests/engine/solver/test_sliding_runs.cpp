// What a sliding side writes (E1, E2) and when its motion verifies (E5), for runs of every length and
// position: the loops take four vectors at a time, then single vectors, or single nodes.
#include <gtest/gtest.h>

#include <vector>

#include "capstan/solver/sliding_run.h"
#include "example_cables.h"

namespace capstan {
namespace {

constexpr int nodes = 45;
constexpr double step_m = 1e-5;
constexpr double rounding_m = 0.4 * displacement_rounding_m;

class SlidingRuns : public testing::TestWithParam<Direction> {
  protected:
    SlidingRuns() {
        for (int node = 0; node < nodes + 3; ++node) {
            ratio.push_back(1.0 + 0.1 * node);
            elongation_m_per_N.push_back(1e-4 * (node + 0.01 * node * node));
            state.tension_N.push_back(7.0);
            state.displacement_m.push_back(0.0);
        }
        // Every node has moved by step_m in the run's direction.
        for (int node = 0; node < nodes + 3; ++node) set_increment(node, step_m);
    }

    SlidingRun run(int first, int end) const {
        return {first, end, GetParam(), 3.0, 2e-3, -1.5, ratio.data(), elongation_m_per_N.data()};
    }
    double displacement_m(int node) const { return 2e-3 - 1.5 * elongation_m_per_N[node]; }
    // How far the run moves this node in its direction.
    void set_increment(int node, double increment_m) {
        state.displacement_m[node] = displacement_m(node) - sign(GetParam()) * increment_m;
    }
    bool moves_under(const ModelRules& rules, int first, int end) const {
        return moves(run(first, end), {tables, rules, state});
    }

    const Cable cable = test::paper_cable(4);
    const PrefixTables tables{cable, ModelRules::consistent()};
    std::vector<double> ratio;
    std::vector<double> elongation_m_per_N;
    CableState state;
};

TEST_P(SlidingRuns, WriteTheirOwnNodesOnly) {
    const CableState before = state;
    for (int first = 0; first <= nodes; ++first) {
        for (int end = first; end <= nodes; ++end) {
            CableState after = before;
            write_run(run(first, end), after);
            for (int node = 0; node < nodes; ++node) {
                const bool slides = first <= node && node < end;
                ASSERT_DOUBLE_EQ(after.tension_N[node], slides ? 3.0 * ratio[node] : 7.0);
                ASSERT_DOUBLE_EQ(after.displacement_m[node],
                                 slides ? displacement_m(node) : before.displacement_m[node]);
            }
        }
    }
}

TEST_P(SlidingRuns, VerifyIfEveryNodeMovesTheirWay) {
    for (const int first : {0, 1, 6}) {
        for (int end = first; end <= nodes; ++end) {
            EXPECT_TRUE(moves_under(ModelRules::consistent(), first, end));
            for (int node = 0; node < nodes; ++node) {
                set_increment(node, -step_m);
                const bool lags = first <= node && node < end;
                ASSERT_EQ(moves_under(ModelRules::consistent(), first, end), !lags)
                    << first << " " << end << " " << node;
                set_increment(node, step_m);
            }
        }
    }
}

// Every other node goes back by half of what its neighbours move: the mean of each segment moves forward.
TEST_P(SlidingRuns, VerifyUnderThePapersRulesIfTheMeanOfEverySegmentMovesTheirWay) {
    for (int node = 1; node < nodes + 3; node += 2) set_increment(node, -0.5 * step_m);
    for (const int first : {0, 1, 6}) {
        for (int end = first + 1; end <= nodes; ++end) {
            EXPECT_TRUE(moves_under(ModelRules::paper(), first, end));
            EXPECT_EQ(moves_under(ModelRules::consistent(), first, end), end == first + 1 && first % 2 == 0);
            for (int node = 1; node < nodes; node += 2) {
                set_increment(node, -2.0 * step_m);
                const bool is_in = first <= node && node < end && end - first > 1;
                ASSERT_EQ(moves_under(ModelRules::paper(), first, end), !is_in)
                    << first << " " << end << " " << node;
                set_increment(node, -0.5 * step_m);
            }
        }
    }
}

TEST_P(SlidingRuns, VerifyWithinRounding) {
    for (int node = 0; node < nodes; ++node) set_increment(node, -rounding_m);
    for (const ModelRules& rules : {ModelRules::consistent(), ModelRules::paper()}) {
        for (int end = 1; end <= nodes; ++end) EXPECT_TRUE(moves_under(rules, 0, end)) << end;
    }
}

TEST_P(SlidingRuns, AreWrittenOnlyIfBothSidesVerify) {
    for (const ModelRules& rules : {ModelRules::consistent(), ModelRules::paper()}) {
        const StepView view{tables, rules, state};
        for (const int far_first : {6, 20, nodes}) {  // the last one: no distal side
            for (const bool near_moves : {true, false}) {
                for (const bool far_moves : {true, false}) {
                    for (int node = 0; node < nodes; ++node)
                        set_increment(node, (node < 6 ? near_moves : far_moves) ? step_m : -step_m);
                    const CableState before = state;
                    CableState after = before;
                    const bool both = near_moves && (far_moves || far_first == nodes);
                    EXPECT_EQ(write_if_both_move(run(0, 5), run(far_first, nodes), view, after), both);
                    for (int node = 0; node < nodes; ++node) {
                        const bool written = both && (node < 5 || node >= far_first);
                        ASSERT_DOUBLE_EQ(after.tension_N[node], written ? 3.0 * ratio[node] : 7.0);
                        ASSERT_DOUBLE_EQ(after.displacement_m[node],
                                         written ? displacement_m(node) : before.displacement_m[node]);
                    }
                }
            }
        }
    }
}

TEST_P(SlidingRuns, AreWrittenUnderThePapersRulesIfTheirMeansVerify) {
    for (int node = 1; node < nodes; node += 2) set_increment(node, -0.5 * step_m);
    const SlidingRun near = run(0, 5);
    const SlidingRun far = run(20, nodes);
    const ModelRules consistent = ModelRules::consistent();
    const ModelRules paper = ModelRules::paper();
    CableState after = state;
    EXPECT_FALSE(write_if_both_move(near, far, {tables, consistent, state}, after));
    EXPECT_EQ(after.displacement_m, state.displacement_m);
    EXPECT_TRUE(write_if_both_move(near, far, {tables, paper, state}, after));
    EXPECT_DOUBLE_EQ(after.displacement_m.front(), displacement_m(0));
}

TEST_P(SlidingRuns, VerifyAndWriteNothingIfTheyAreEmpty) {
    EXPECT_TRUE(SlidingRun{}.empty());
    EXPECT_EQ(SlidingRun{}.end - SlidingRun{}.first, 0);
    for (const ModelRules& rules : {ModelRules::consistent(), ModelRules::paper()}) {
        EXPECT_TRUE(moves(SlidingRun{}, {tables, rules, state}));
    }
    const CableState before = state;
    write_run(SlidingRun{}, state);
    EXPECT_EQ(state.tension_N, before.tension_N);
}

INSTANTIATE_TEST_SUITE_P(BothWays, SlidingRuns, testing::Values(Direction::forward, Direction::backward),
                         [](const auto& which) {
                             return which.param == Direction::forward ? "Forward" : "Backward";
                         });

}  // namespace
}  // namespace capstan
