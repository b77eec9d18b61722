// With worlds drawn from what the estimator is told, a further sensor cannot raise the expected squared error
// of the posterior mean. The ensemble filter approximates that mean; here is how well. Nor is anything
// recommended that is worse than no sensor.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>

#include "capstan/config/plan_checks.h"
#include "capstan/platform/parallel_for.h"
#include "capstan/worlds/choice.h"
#include "particle_filter.h"
#include "random_plans.h"

namespace capstan {
namespace {

using testing::make_small;
using testing::random_plan;

// Of squared errors; of the mean absolute error in N.
struct Rise {
    double before_N2 = 0.0;
    double mean_N2 = 0.0;
    double standard_error_N2 = 0.0;

    bool is_exception() const { return mean_N2 > std::max(3.0 * standard_error_N2, 0.02 * before_N2); }
};

Rise rise_of(const std::vector<double>& fewer_N2, const std::vector<double>& more_N2) {
    Rise rise;
    const double count = static_cast<double>(fewer_N2.size());
    double squares = 0.0;
    for (std::size_t w = 0; w < fewer_N2.size(); ++w) {
        const double each = more_N2[w] - fewer_N2[w];
        rise.before_N2 += fewer_N2[w] / count;
        rise.mean_N2 += each / count;
        squares += each * each / count;
    }
    rise.standard_error_N2 = std::sqrt((squares - rise.mean_N2 * rise.mean_N2) / (count - 1.0));
    return rise;
}

struct Seen {
    int plans = 0;
    int pairs = 0;
    int exceptions = 0;
    int recommended = 0;

    void print(const char* what) const {
        std::printf("%d %s: %d pairs, %d exceptions; something is recommended for %d\n", plans, what, pairs,
                    exceptions, recommended);
    }
};

std::vector<double> particle_squares_N2(const StudyPlan& plan, const std::vector<int>& sensors, int worlds) {
    const WorldQuestion question = world_question(plan);
    std::vector<double> squares_N2(static_cast<std::size_t>(worlds));
    parallel_for_each_index(worlds, 0, [&](int w) {
        const World world = draw_world(question, static_cast<std::uint32_t>(w));
        squares_N2[static_cast<std::size_t>(w)] = testing::particle_square_N2(question, world, sensors);
    });
    return squares_N2;
}

// In worlds that had no part in choosing it, nor in the comparison that makes it a recommendation.
void expect_that_a_recommendation_helps(ErrorTable& table, Seen& seen) {
    Choice choice(table);
    const WorldAnswer answer = choose_of_each_price(choice);
    if (!answer.recommended) return;
    ++seen.recommended;
    const int set = answer.best().expected.candidate;
    const int worlds = choice.worlds();
    const std::vector<int> both = {0, set};
    choice.fill(Condition::as_stated, both, 2 * worlds, 3 * worlds, "test");
    for (const auto of : {&WorldError::mean_abs_N, &WorldError::mean_square_N2}) {
        const auto values = [&](int candidate) {
            std::vector<double> all;
            for (int w = 2 * worlds; w < 3 * worlds; ++w)
                all.push_back(table.at(Condition::as_stated, candidate, w).*of);
            return all;
        };
        const Rise rise = rise_of(values(0), values(set));
        EXPECT_LE(rise.mean_N2, 3.0 * rise.standard_error_N2)
            << table.plan().name << ": " << words_of(choice.candidate(set), table.offers());
    }
}

// All nested pairs of a plan's sets, and what is recommended of them against no sensor.
void expect_the_law(StudyPlan plan, int worlds, Seen& seen) {
    plan.repetitions = worlds;
    ErrorTable table(plan, {});
    const auto& candidates = table.candidates();
    std::vector<int> all;
    for (int k = 0; k < static_cast<int>(candidates.size()); ++k) all.push_back(k);
    table.fill(Condition::as_stated, all, 0, worlds, "test");
    const auto squares_N2 = [&](int candidate) {
        std::vector<double> values;
        for (int w = 0; w < worlds; ++w)
            values.push_back(table.at(Condition::as_stated, candidate, w).mean_square_N2);
        return values;
    };
    for (const int a : all) {
        for (const int b : all) {
            const auto& fewer = candidates[static_cast<std::size_t>(a)].sensors;
            const auto& more = candidates[static_cast<std::size_t>(b)].sensors;
            if (fewer.size() >= more.size() ||
                !std::includes(more.begin(), more.end(), fewer.begin(), fewer.end()))
                continue;
            ++seen.pairs;
            const Rise rise = rise_of(squares_N2(a), squares_N2(b));
            if (!rise.is_exception()) continue;
            ++seen.exceptions;
            const int checked = std::min(worlds, 6);
            const Rise reference =
                rise_of(particle_squares_N2(plan, fewer, checked), particle_squares_N2(plan, more, checked));
            std::printf(
                "%s: from %s to %s the ensemble filter's squared error rises by %.4f +- %.4f N^2 of %.4f; a "
                "particle filter's changes by %+.4f +- %.4f of %.4f\n",
                plan.name.c_str(), words_of(candidates[static_cast<std::size_t>(a)], table.offers()).c_str(),
                words_of(candidates[static_cast<std::size_t>(b)], table.offers()).c_str(), rise.mean_N2,
                rise.standard_error_N2, rise.before_N2, reference.mean_N2, reference.standard_error_N2,
                reference.before_N2);
            EXPECT_FALSE(reference.is_exception());
        }
    }
    ++seen.plans;
    expect_that_a_recommendation_helps(table, seen);
}

TEST(SlowFurtherSensor, NeverRaisesTheSquaredErrorOnAShippedConfiguration) {
    Seen seen;
    for (const auto& entry : std::filesystem::directory_iterator(CONFIGS_FOLDER)) {
        // A bench has no sensors to place.
        const std::string name = entry.path().filename().string();
        if (entry.path().extension() != ".toml" || name.starts_with("bench-")) continue;
        StudyPlan plan = config::read_config(entry.path().string()).plan;
        // A study over worlds prescribes the motor's position.
        if (plan.motion.proximal.kind != EndKind::position) continue;
        make_small(plan);
        if (plan.uncertainty.far_end_range_m == 0.0) plan.uncertainty.far_end_range_m = 0.00063;
        expect_the_law(plan, 30, seen);
    }
    seen.print("configurations");
    EXPECT_GE(seen.plans, 7);
    EXPECT_GT(seen.pairs, 100);
    EXPECT_LE(seen.exceptions, seen.pairs / 100);
    EXPECT_GT(seen.recommended, 0);
}

// Poor sensors, few long segments and a static friction three times the dynamic one: a segment slides either
// way, and the ensemble filter's normal distribution lies between. Here the law has exceptions, which are
// listed.
TEST(SlowFurtherSensor, RaisesTheSquaredErrorOfAParticleFilterNowhere) {
    StudyPlan plan = config::read_config(CONFIGS_FOLDER "/noise-sweep.toml").plan;
    plan.name = "noise sweep, 20 %, 4 segments";
    make_small(plan);
    plan.motion.samples = 200;
    plan.sensors.front().errors.multiplicative_ratio = 0.2;
    plan.transmission.cable.segments = 4;
    plan.transmission.cable.static_friction = 3.0 * plan.transmission.cable.dynamic_friction;
    place_nodes(plan);
    Seen seen;
    expect_the_law(plan, 200, seen);
    seen.print("configuration");
    EXPECT_LE(seen.exceptions, seen.pairs / 5);
}

Seen seen_on_random_cables(unsigned first, unsigned last) {
    Seen seen;
    for (unsigned number = first; number <= last; ++number) expect_the_law(random_plan(number), 30, seen);
    seen.print("random cables");
    return seen;
}

TEST(FurtherSensor, NeverRaisesTheSquaredErrorOnFourRandomCables) {
    const Seen seen = seen_on_random_cables(101, 104);
    EXPECT_EQ(seen.plans, 4);
    EXPECT_GT(seen.pairs, 40);
    EXPECT_EQ(seen.exceptions, 0);
}

TEST(SlowFurtherSensor, NeverRaisesTheSquaredErrorOnTwentyRandomCables) {
    const Seen seen = seen_on_random_cables(101, 120);
    EXPECT_EQ(seen.plans, 20);
    EXPECT_GT(seen.pairs, 300);
    EXPECT_LE(seen.exceptions, seen.pairs / 100);
    EXPECT_GT(seen.recommended, 10);
}

// An encoder of 10 um tells the tension of its spring to 0.02 N, from the pretension that the reading before
// it corrected.
TEST(FurtherSensor, APreciseEncoderBesideATorqueNeverRaisesTheSquaredError) {
    const StudyPlan plan = config::parse_config(R"(
[transmission]
length_m = 1.4
axial_stiffness_N = 12000
dynamic_friction = 0.15
pretension_N = 10
[[transmission.bend]]
angle_deg = 120
radius_m = 0.05
at_m = 0.7
[motion]
samples = 100
[motion.proximal]
kind = "position"
amplitude_m = 0.003
[motion.distal]
kind = "spring"
spring_stiffness_N_per_m = 2000
[uncertainty]
friction_fraction = 0.2
[[sensor]]
kind = "motor_torque"
noise_N = 1
[[sensor]]
kind = "load_displacement"
noise_m = 1e-5
)",
                                                "precise encoder")
                               .plan;
    Seen seen;
    expect_the_law(plan, 60, seen);
    EXPECT_EQ(seen.pairs, 5);
    EXPECT_EQ(seen.exceptions, 0);
}

// The particle filter's error is the floor; the ensemble filter comes near it.
void expect_near_a_particle_filter(unsigned number) {
    StudyPlan plan = random_plan(200 + number);
    plan.transmission.cable.segments = 4 + 2 * static_cast<int>(number % 2);
    plan.motion.samples = 50;
    plan.uncertainty.members = 128;
    constexpr int worlds = 8;
    ErrorTable table(plan, {});
    const int one = 1;
    const int most = static_cast<int>(table.candidates().size()) - 1;
    const std::vector<int> some = {one, most};
    table.fill(Condition::as_stated, some, 0, worlds, "test");
    for (const int candidate : some) {
        const auto& set = table.candidates()[static_cast<std::size_t>(candidate)];
        std::vector<double> ensemble_N2;
        for (int w = 0; w < worlds; ++w)
            ensemble_N2.push_back(table.at(Condition::as_stated, candidate, w).mean_square_N2);
        const Rise over = rise_of(particle_squares_N2(plan, set.sensors, worlds), ensemble_N2);
        std::printf("%s, %s: particle filter %.5f N^2, ensemble filter %+.5f +- %.5f\n", plan.name.c_str(),
                    words_of(set, table.offers()).c_str(), over.before_N2, over.mean_N2,
                    over.standard_error_N2);
        EXPECT_LT(over.mean_N2, 3.0 * over.standard_error_N2 + 0.2 * over.before_N2);
    }
}

TEST(SlowFurtherSensor, LeavesTheEnsembleFilterNearAParticleFilter) {
    // The second has few segments: the state of each matters most.
    for (const unsigned number : {1U, 2U, 3U}) expect_near_a_particle_filter(number);
}

}  // namespace
}  // namespace capstan
