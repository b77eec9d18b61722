// The step's answer against every one of the 3^N sign vectors, and against the same step taken in 10, 100 and
// 1000 sub-steps, over random walks of both ends. Several states can pass every check of a step; the answer
// is the one that continuous motion from the previous state reaches, the limit of the sub-steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <random>

#include "capstan/solver/pattern_search.h"
#include "example_cables.h"
#include "random_walk.h"
#include "sign_vector_enumeration.h"
#include "sub_steps.h"

namespace capstan {
namespace {

using test::InputPair;

// What stands for infinitely many sub-steps, where several states verify and where one does.
constexpr int finest = 1000;
constexpr int fine = 200;

// Largest difference of a node's tension, relative to the larger of the two.
double apart_N(const CableState& a, const CableState& b) {
    double largest = 0.0;
    for (std::size_t node = 0; node < a.tension_N.size(); ++node) {
        const double size_N = std::max(a.tension_N[node], b.tension_N[node]);
        largest = std::max(largest, std::abs(a.tension_N[node] - b.tension_N[node]) / size_N);
    }
    return largest;
}

int moved_nodes(const CableState& before, const CableState& after) {
    int moved = 0;
    for (std::size_t node = 0; node < before.displacement_m.size(); ++node) {
        moved += std::abs(after.displacement_m[node] - before.displacement_m[node]) > 1e-10;
    }
    return moved;
}

// Steps of one kind: how far 1, 10 and 100 sub-steps end from their limit.
struct Convergence {
    int steps = 0;
    std::array<double, 3> largest{};  // 1, 10, 100 sub-steps
    std::array<std::vector<double>, 3> all;

    void add(const QuasiStaticStep& step, const CableState& before, const EndConditions& ends,
             const CableState& after, const CableState& limit) {
        ++steps;
        const std::array<double, 3> distance{
            apart_N(after, limit), apart_N(test::in_sub_steps(step, before, ends, 10).after, limit),
            apart_N(test::in_sub_steps(step, before, ends, 100).after, limit)};
        for (int k = 0; k < 3; ++k) {
            largest[k] = std::max(largest[k], distance[k]);
            all[k].push_back(distance[k]);
        }
    }
    double median(int k) {
        if (all[k].empty()) return 0.0;
        std::sort(all[k].begin(), all[k].end());
        return all[k][all[k].size() / 2];
    }
    void tell(const char* name) {
        std::cout << "    " << name << ": " << steps
                  << " steps; distance from the limit, largest (median): 1 step " << largest[0] << " ("
                  << median(0) << "), 10 sub-steps " << largest[1] << " (" << median(1) << "), 100 sub-steps "
                  << largest[2] << " (" << median(2) << ")\n";
    }
};

struct SubStepTally {
    int steps = 0;
    int several = 0;             // more than one state verifies
    int none = 0;                // no state verifies
    int not_among = 0;           // the step's state is not among those that verify
    int not_least = 0;           // another state that verifies moves fewer nodes
    int unverified = 0;          // the step or a sub-step says of itself that it is not verified
    std::vector<double> spread;  // of the states that verify, where there are several
    Convergence ambiguous;       // several states verify
    Convergence single;          // one state verifies, and no sub-step has a zero-velocity point
    Convergence opposed;         // one state verifies, and a sub-step has a zero-velocity point

    int failures() const { return none + not_among + unverified; }
    void tell() {
        std::sort(spread.begin(), spread.end());
        std::cout << "    " << steps << " steps: " << failures() << " failed, " << several
                  << " with several states that pass every check";
        if (several > 0) {
            std::cout << ", apart by " << spread[spread.size() / 2] << " in the median and " << spread.back()
                      << " at most";
        }
        std::cout << "\n";
        ambiguous.tell("several states");
        single.tell("one state");
        opposed.tell("one state, zero-velocity point");
    }
};

class Walks {
  public:
    explicit Walks(double static_friction) : static_friction_(static_friction) {}

    // Every number of segments from 2 to 6, every pair of inputs, both conduits.
    void in_every_mode(double step_m, unsigned seed) {
        for (int segments = 2; segments <= 6; ++segments) {
            for (const InputPair& pair : test::every_input_pair()) {
                SCOPED_TRACE(test::name_of(pair) + std::to_string(segments) + "Segments");
                // Six segments have 729 sign vectors, so they take fewer steps.
                const int steps = segments < 5 ? 400 : segments < 6 ? 150 : 75;
                for (const Conduit conduit : {Conduit::bent_evenly, Conduit::bends_differ}) {
                    walk(cable_of(segments, conduit), pair, step_m, steps, seed);
                }
                EXPECT_EQ(tally.failures(), 0);
            }
        }
    }
    void of_both_positions(int segments, double step_m, int steps, unsigned seed) {
        walk(cable_of(segments, Conduit::bent_evenly), {test::EndKind::position, test::EndKind::position},
             step_m, steps, seed);
        EXPECT_EQ(tally.failures(), 0);
    }

    SubStepTally tally;

  private:
    enum class Conduit { bent_evenly, bends_differ };

    Cable cable_of(int segments, Conduit conduit) const {
        CableSpecification specification = test::paper_specification(segments);
        specification.static_friction = static_friction_;
        if (conduit == Conduit::bends_differ) {
            std::mt19937_64 random(segments);
            std::uniform_real_distribution<double> radius_m(0.1, 0.6);
            specification.curvature.clear();
            for (int piece = 0; piece < 7; ++piece) {
                specification.curvature.push_back({2.0 / 7.0, piece == 3 ? straight : radius_m(random)});
            }
        }
        return Cable(specification);
    }

    void walk(const Cable& cable, const InputPair& pair, double step_m, int steps, unsigned seed) {
        constexpr int steps_from_one_state = 25;
        const QuasiStaticStep step(cable, ModelRules::consistent());
        test::RandomWalk walk(cable, pair, step_m, seed);
        CableState state = pretensioned(cable);
        for (int k = 0; k < steps; ++k) {
            if (k % steps_from_one_state == 0) state = test::random_state(step, seed + k);
            const EndConditions ends = walk.next(state);
            CableState next = state;
            const StepReport report = step.advance(next, ends);
            if (report.pattern.kind == MotionKind::slack || !test::moderately_stretched(next)) {
                state = test::random_state(step, seed + steps + k);
                continue;
            }
            ++tally.steps;
            tally.unverified += !report.verified;
            compare(step, state, ends, next);
            state = next;
        }
    }

    void compare(const QuasiStaticStep& step, const CableState& before, const EndConditions& ends,
                 const CableState& after) {
        const auto verified = test::all_verified_states(step.cable(), before, ends, 1e-7);
        tally.none += verified.empty();
        if (verified.empty()) return;
        int fewest = step.cable().nodes();
        double nearest = 1.0;
        double spread = 0.0;
        for (const CableState& state : verified) {
            fewest = std::min(fewest, moved_nodes(before, state));
            nearest = std::min(nearest, apart_N(state, after));
            for (const CableState& other : verified) spread = std::max(spread, apart_N(state, other));
        }
        tally.not_among += nearest > 1e-6;
        tally.not_least += fewest < moved_nodes(before, after);
        const test::SubSteps limit =
            test::in_sub_steps(step, before, ends, verified.size() > 1 ? finest : fine);
        tally.unverified += !limit.verified;
        if (verified.size() > 1) {
            ++tally.several;
            tally.spread.push_back(spread);
        }
        Convergence& kind = verified.size() > 1         ? tally.ambiguous
                            : limit.zero_velocity_point ? tally.opposed
                                                        : tally.single;
        kind.add(step, before, ends, after, limit.after);
    }

    double static_friction_;
};

// Rounding of a thousand sub-steps.
constexpr double rounding = 1e-10;

TEST(SubSteps, ReachTheStepsAnswerAlsoWhereSeveralStatesPassEveryCheck) {
    Walks walks(0.21);
    walks.in_every_mode(2e-5, 17);
    walks.in_every_mode(1e-4, 7);
    walks.of_both_positions(4, 4e-4, 3000, 11);
    SubStepTally& tally = walks.tally;
    tally.tell();
    EXPECT_GT(tally.several, tally.steps / 20);
    EXPECT_GT(tally.opposed.steps, tally.steps / 20);
    EXPECT_LT(tally.ambiguous.largest[0], rounding);
    EXPECT_LT(tally.single.largest[0], rounding);
    // Where a zero-velocity point moves along the cable a step has an error of the first order in its length.
    EXPECT_LT(tally.opposed.median(1), 0.2 * tally.opposed.median(0));
    EXPECT_LT(tally.opposed.median(2), 0.2 * tally.opposed.median(1));
}

// With mu_s above mu_d a front may both hold and give way, so most steps have several states: the step moves
// no more nodes than it must, and so do the sub-steps.
TEST(SubSteps, WithStictionReachTheStepsAnswerWhichMovesTheFewestNodes) {
    Walks walks(0.63);
    walks.in_every_mode(1e-4, 13);
    SubStepTally& tally = walks.tally;
    tally.tell();
    EXPECT_EQ(tally.not_least, 0);
    EXPECT_GT(tally.several, tally.steps / 2);
    EXPECT_LT(tally.ambiguous.largest[0], rounding);
}

// Long cables have too many sign vectors to try them all. `visit` gets every step without a zero-velocity
// point: the state before, the motion of the step, and how far it ends from its sub-steps.
template <class Visit>
void on_long_cables(double static_friction, const Visit& visit) {
    for (const int segments : {10, 40}) {
        CableSpecification specification = test::paper_specification(segments);
        specification.static_friction = static_friction;
        const QuasiStaticStep step(Cable(specification), ModelRules::consistent());
        for (const InputPair& pair : test::every_input_pair()) {
            for (const double step_m : {1e-5, 1e-4, 1e-3, 5e-3}) {
                test::RandomWalk walk(step.cable(), pair, step_m, 23);
                for (int k = 0; k < 200; ++k) {
                    const CableState before = test::random_state(step, k);
                    const EndConditions ends = walk.next(before);
                    CableState after = before;
                    const StepReport report = step.advance(after, ends);
                    if (!test::moderately_stretched(after)) continue;
                    const test::SubSteps limit = test::in_sub_steps(step, before, ends, 50);
                    if (!limit.zero_velocity_point && report.pattern.kind != MotionKind::opposed)
                        visit(before, report.pattern, apart_N(after, limit.after));
                }
            }
        }
    }
}

// Steps up to half the cable's stretch.
TEST(SubSteps, ReachTheStepsAnswerOnLongCables) {
    int compared = 0;
    double largest = 0.0;
    on_long_cables(0.21, [&](const CableState&, const MotionPattern&, double distance) {
        ++compared;
        largest = std::max(largest, distance);
    });
    std::cout << "    " << compared << " steps of 10 and 40 segments, largest distance " << largest << "\n";
    EXPECT_GT(compared, 5000);
    EXPECT_LT(largest, rounding);
}

// With stiction a step can differ from its sub-steps. Right after an end turned, the step holds by mu_d what
// slid in the step before, and the sub-steps, after their first, by mu_s. Rarely, a front that breaks away
// lets the tension fall, and the sub-steps then go another way than one step across that fall.
TEST(SubSteps, WithStictionDifferFromTheStepNearlyOnlyWhereAnEndTurns) {
    int compared = 0;
    int differ = 0;
    int without_turn = 0;
    double largest = 0.0;
    on_long_cables(0.63, [&](const CableState& before, const MotionPattern& now, double distance) {
        ++compared;
        if (distance < rounding) return;
        ++differ;
        largest = std::max(largest, distance);
        const auto turns = [](Direction last, Direction next) {
            return last != Direction::none && next == opposite(last);
        };
        const MotionPattern& last = before.last_motion;
        without_turn += !turns(last.proximal_direction, now.proximal_direction) &&
                        !turns(last.distal_direction, now.distal_direction);
    });
    std::cout << "    " << differ << " of " << compared << " steps differ, by " << largest
              << " at most; no end turned in " << without_turn << " of them\n";
    EXPECT_GT(compared, 5000);
    EXPECT_LT(without_turn, compared / 1000);
}

// QuasiStaticStep tries the likely pattern in a way of its own; the search must not answer otherwise.
TEST(PatternSearch, FindsThePatternOfTheStep) {
    int held_middles = 0;
    for (const double static_friction : {0.21, 0.63}) {
        CableSpecification specification = test::paper_specification(10);
        specification.static_friction = static_friction;
        const QuasiStaticStep step(Cable(specification), ModelRules::consistent());
        for (const InputPair& pair : test::every_input_pair()) {
            test::RandomWalk walk(step.cable(), pair, 1e-4, 29);
            CableState state = test::random_state(step, 29);
            for (int k = 0; k < 400; ++k) {
                const EndConditions ends = walk.next(state);
                const PatternSearch search = search_pattern({step.tables(), step.rules(), state}, ends);
                const MotionPattern& found = search.candidate.pattern;
                ASSERT_EQ(step.advance(state, ends).pattern, found);
                held_middles += found.kind == MotionKind::partial &&
                                found.proximal_moving_nodes + found.distal_moving_nodes == 11;
            }
        }
    }
    EXPECT_GT(held_middles, 50);
}

}  // namespace
}  // namespace capstan
