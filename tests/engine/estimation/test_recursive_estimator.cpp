#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "capstan/cable/invalid_input.h"
#include "capstan/estimation/recursive_estimator.h"
#include "capstan/sensing/random_stream.h"
#include "example_cables.h"

namespace capstan {
namespace {

constexpr int steps_per_cycle = 100;

// The paper's motion: 1 cm at the proximal end, slack for an instant once a cycle.
double proximal_m(const Cable& cable, int step) {
    return pretensioned(cable).displacement_m.front() +
           0.01 * std::sin(2.0 * std::numbers::pi * step / steps_per_cycle);
}

struct Trial {
    std::vector<int> sensors;
    NoiseLevel noise;
    EndWander wander;            // what the estimator is told
    double true_wander_m = 0.0;  // of the distal end
    int cycles = 1;
    std::uint32_t repetition = 0;
};

struct AtNode {
    double error_N = 0.0;
    double deviation_N = 0.0;
};

// Simulates the truth and the estimator side by side; `judge` sees every node of every step.
void run_trial(const QuasiStaticStep& model, const Trial& trial, const std::function<void(AtNode)>& judge) {
    CableState truth = pretensioned(model.cable());
    RecursiveSettings settings;
    settings.wander = trial.wander;
    settings.seed = 100 + trial.repetition;
    RecursiveEstimator estimator(model, truth, settings);
    double distal_m = 0.0;
    for (int step = 1; step <= trial.cycles * steps_per_cycle; ++step) {
        const DrawAddress address{7, static_cast<std::uint32_t>(step), trial.repetition};
        const RandomAddress motion{99, RandomPurpose::reading_noise, static_cast<std::uint32_t>(step),
                                   trial.repetition, 1000};
        distal_m += trial.true_wander_m * standard_normals(motion)[0];
        const double near_m = proximal_m(model.cable(), step);
        model.advance(truth, {EndCondition::position_m(near_m), EndCondition::position_m(distal_m)});
        std::vector<double> all_N(truth.tension_N.size());
        read_tensions(trial.noise, draw_readings(address, model.cable().nodes()), truth.tension_N, all_N);
        std::vector<TensionReading> readings;
        for (const int node : trial.sensors) {
            readings.push_back(
                {spot_of_node(model.cable(), node), all_N[static_cast<std::size_t>(node)], trial.noise});
        }
        estimator.step({near_m, 0.0}, readings);
        for (std::size_t node = 0; node < truth.tension_N.size(); ++node) {
            judge({estimator.mean_N()[node] - truth.tension_N[node], estimator.deviation_N()[node]});
        }
    }
}

struct Tally {
    double mean_error_N = 0.0;
    double coverage = 0.0;
};

Tally tally(const QuasiStaticStep& model, Trial trial, int repetitions) {
    double errors_N = 0.0;
    double within = 0.0;
    double count = 0.0;
    for (int repetition = 0; repetition < repetitions; ++repetition) {
        trial.repetition = static_cast<std::uint32_t>(repetition);
        run_trial(model, trial, [&](const AtNode& at) {
            errors_N += std::abs(at.error_N);
            within += std::abs(at.error_N) <= 1.96 * at.deviation_N + 1e-9;
            ++count;
        });
    }
    return {errors_N / count, within / count};
}

const QuasiStaticStep& paper_model() {
    static const QuasiStaticStep model(test::paper_cable(10), ModelRules::consistent());
    return model;
}

TEST(RecursiveEstimator, WithBothEndsKnownItIsTheModelForAnyReadings) {
    Trial trial;
    trial.sensors = {3};
    trial.noise.additive_N = 5.0;
    trial.cycles = 2;
    run_trial(paper_model(), trial, [](const AtNode& at) {
        ASSERT_NEAR(at.error_N, 0.0, 1e-9);
        ASSERT_NEAR(at.deviation_N, 0.0, 1e-9);
    });
}

// A far end that moves unseen, and the readings are the answer. Not to the last bit: a gain counts only by
// how far its correlation is beyond chance, so that a step takes a little less than the full correction.
TEST(RecursiveEstimator, WithoutNoiseAndASensorAtEveryNodeItIsRightToMillinewtons) {
    Trial trial;
    for (int node = 0; node <= 10; ++node) trial.sensors.push_back(node);
    trial.wander.distal_m = 1e-4;
    trial.true_wander_m = 1e-4;
    EXPECT_LT(tally(paper_model(), trial, 4).mean_error_N, 5e-3);
}

TEST(RecursiveEstimator, ErrsNoMoreOnSegmentsOfUnequalLength) {
    CableSpecification specification = test::paper_specification(9);
    const QuasiStaticStep even(Cable(specification), ModelRules::consistent());
    specification.node_places_m = {0.1, 0.25, 1.1, 1.4};
    const QuasiStaticStep uneven(Cable(specification), ModelRules::consistent());
    Trial trial;
    for (int node = 0; node <= 9; ++node) trial.sensors.push_back(node);
    trial.wander.distal_m = 1e-4;
    trial.true_wander_m = 1e-4;
    EXPECT_LT(tally(uneven, trial, 40).mean_error_N, 1.2 * tally(even, trial, 40).mean_error_N);
}

// The truth is drawn from what the estimator is told. Members are few and the posterior is not normal: 93
// to 97.
TEST(RecursiveEstimator, The95PercentBandHoldsTheTruthOnSimulatedCycles) {
    for (const std::vector<int>& sensors : {std::vector{10}, std::vector{4, 7, 10}, std::vector{0, 10}}) {
        for (const double wander_m : {3e-5, 1e-4}) {
            Trial trial;
            trial.sensors = sensors;
            trial.noise.multiplicative_ratio = 0.1;
            trial.wander.distal_m = wander_m;
            trial.true_wander_m = wander_m;
            trial.cycles = 2;
            const Tally result = tally(paper_model(), trial, 60);
            EXPECT_GE(result.coverage, 0.93) << sensors.size() << " sensors, wander " << wander_m;
            EXPECT_LE(result.coverage, 0.97) << sensors.size() << " sensors, wander " << wander_m;
        }
    }
}

// The product of two normal densities, at the sensor's own node, where no correlation is left to chance.
TEST(RecursiveEstimator, AReadingLeavesTheDeviationOfBothTogether) {
    constexpr int node = 4;
    constexpr double noise_N = 0.5;
    RecursiveSettings settings;
    settings.wander.distal_m = 2e-3;
    const CableState start = pretensioned(paper_model().cable());
    RecursiveEstimator without(paper_model(), start, settings);
    RecursiveEstimator with(paper_model(), start, settings);
    const KnownEnds ends{start.displacement_m.front() + 5e-3, start.displacement_m.back()};
    without.step(ends, {});
    const double before_N = without.deviation_N()[node];
    const TensionReading reading{
        spot_of_node(paper_model().cable(), node), without.mean_N()[node], {.additive_N = noise_N}};
    with.step(ends, std::span(&reading, 1));
    ASSERT_GT(before_N, 0.2 * noise_N);
    EXPECT_NEAR(with.deviation_N()[node], before_N * noise_N / std::hypot(before_N, noise_N), 1e-6);
    EXPECT_NEAR(with.mean_N()[node], without.mean_N()[node], 1e-6);
}

// Both ends move alike, so that the complete cable slides at that speed: in a segment the tension grows by
// the exponent of Coulomb friction and by the drag over the mean tension (E41), from the first step on. There
// the two trials of a step leave 1.6% of the growth, one trial would leave 16%.
TEST(RecursiveEstimator, WhereTheCableSlidesTheTensionGrowsByFrictionAndDrag) {
    constexpr double speed_m_per_s = 0.2;
    constexpr double interval_s = 0.2;
    constexpr double drag_N_s_per_m2 = 3.0;
    const Cable& cable = paper_model().cable();
    const CableState start = pretensioned(cable);
    for (const auto& [drag, steps] :
         {std::pair{0.0, 1}, std::pair{drag_N_s_per_m2, 1}, std::pair{drag_N_s_per_m2, 20}}) {
        RecursiveSettings settings;
        settings.members = 8;
        settings.rate_friction.viscous.drag_N_s_per_m2 = drag;
        settings.interval_s = interval_s;
        RecursiveEstimator estimator(paper_model(), start, settings);
        for (int step = 1; step <= steps; ++step) {
            const double moved_m = step * speed_m_per_s * interval_s;
            estimator.step({start.displacement_m.front() + moved_m, start.displacement_m.back() + moved_m},
                           {});
        }
        const std::span<const double> tension_N = estimator.mean_N();
        const double segment_m = cable.mean_segment_length_m();
        for (std::size_t k = 0; k + 1 < tension_N.size(); ++k) {
            const double mean_N = 0.5 * (tension_N[k] + tension_N[k + 1]);
            const double grown = std::log(tension_N[k + 1] / tension_N[k]);
            const double friction = cable.dynamic_friction() * cable.wrap_angle_rad()[k];
            const double of_drag = drag * segment_m * speed_m_per_s / mean_N;
            EXPECT_NEAR(grown, friction + of_drag, 0.02 * (friction + of_drag))
                << drag << ", step " << steps << ", segment " << k;
        }
    }
}

TEST(RecursiveEstimator, MoreReadingsLowerTheErrorMore) {
    Trial trial;
    trial.noise.multiplicative_ratio = 0.1;
    trial.wander.distal_m = 1e-4;
    trial.true_wander_m = 1e-4;
    trial.cycles = 2;
    const double none_N = tally(paper_model(), trial, 20).mean_error_N;
    trial.sensors = {10};
    const double one_N = tally(paper_model(), trial, 20).mean_error_N;
    trial.sensors = {2, 6, 10};
    const double three_N = tally(paper_model(), trial, 20).mean_error_N;
    EXPECT_LT(one_N, 0.7 * none_N);
    EXPECT_LT(three_N, one_N);
}

TEST(RecursiveEstimator, GivesTheSameBitsTwiceAndOthersForAnotherSeed) {
    Trial trial;
    trial.sensors = {10};
    trial.noise.multiplicative_ratio = 0.1;
    trial.wander = {1e-5, 1e-4};
    const auto errors = [&](std::uint32_t repetition) {
        trial.repetition = repetition;
        std::vector<double> all;
        run_trial(paper_model(), trial, [&](const AtNode& at) { all.push_back(at.error_N); });
        return all;
    };
    EXPECT_EQ(errors(1), errors(1));
    EXPECT_NE(errors(1), errors(2));
}

// What a member's tensions and displacements are after a correction is a state that the next step can take.
TEST(RecursiveEstimator, TensionsStayPositiveWhereReadingsAreFarOff) {
    const CableState start = pretensioned(paper_model().cable());
    RecursiveSettings settings;
    settings.wander.distal_m = 1e-4;
    RecursiveEstimator estimator(paper_model(), start, settings);
    for (int step = 1; step <= steps_per_cycle; ++step) {
        TensionReading reading{spot_of_node(paper_model().cable(), 10), step % 2 ? -50.0 : 200.0, {}};
        reading.noise.additive_N = 1.0;
        estimator.step({proximal_m(paper_model().cable(), step), 0.0}, {&reading, 1});
        for (const double mean_N : estimator.mean_N()) {
            ASSERT_TRUE(std::isfinite(mean_N));
            ASSERT_GE(mean_N, 0.0);
        }
    }
}

TEST(RecursiveEstimator, RejectsInvalidInputs) {
    const CableState start = pretensioned(paper_model().cable());
    RecursiveSettings settings;
    settings.members = 30;
    settings.wander.distal_m = -1.0;
    try {
        RecursiveEstimator(paper_model(), start, settings);
        FAIL();
    } catch (const InvalidInput& refusal) {
        EXPECT_EQ(refusal.problems().size(), 2u) << refusal.what();
    }
    EXPECT_THROW(RecursiveEstimator(paper_model(), pretensioned(test::paper_cable(11)), {}), InvalidInput);

    RecursiveEstimator estimator(paper_model(), start, {});
    const std::vector<double> before(estimator.mean_N().begin(), estimator.mean_N().end());
    const TensionReading no_number{
        spot_of_node(paper_model().cable(), 3), std::numeric_limits<double>::quiet_NaN(), {}};
    const TensionReading beyond{{10, 0.0}, 10.0, {}};
    EXPECT_THROW(estimator.step({start.displacement_m.front(), 0.0}, {&no_number, 1}), InvalidInput);
    EXPECT_THROW(estimator.step({start.displacement_m.front(), 0.0}, {&beyond, 1}), InvalidInput);
    EXPECT_EQ(before, std::vector<double>(estimator.mean_N().begin(), estimator.mean_N().end()));
}

TEST(RecursiveEstimator, TakesAPowerOfTwoFrom8To1024AndFiniteNumbersOnly) {
    const CableState start = pretensioned(paper_model().cable());
    for (const int members : {4, 12, 2048}) {
        RecursiveSettings settings;
        settings.members = members;
        EXPECT_THROW(RecursiveEstimator(paper_model(), start, settings), InvalidInput) << members;
    }
    RecursiveSettings far;
    far.wander.proximal_m = std::numeric_limits<double>::infinity();
    EXPECT_THROW(RecursiveEstimator(paper_model(), start, far), InvalidInput);
    CableState torn = start;
    torn.displacement_m.pop_back();
    EXPECT_THROW(RecursiveEstimator(paper_model(), torn, {}), InvalidInput);
    RecursiveEstimator estimator(paper_model(), start, {});
    const double near_m = start.displacement_m.front();
    EXPECT_THROW(estimator.step({std::nan(""), 0.0}, {}), InvalidInput);
    EXPECT_THROW(estimator.step({near_m, std::nan("")}, {}), InvalidInput);
    const TensionReading before_the_cable{{-1, 0.0}, 10.0, {}};
    EXPECT_THROW(estimator.step({near_m, 0.0}, {&before_the_cable, 1}), InvalidInput);
}

// At the end of its range a reading says "at least this": news where less was thought, none where more was.
TEST(RecursiveEstimator, ASensorAtItsEndPullsUpAndNeverDown) {
    const CableState start = pretensioned(paper_model().cable());
    const auto mean_after_N = [&](double range_N, bool read) {
        RecursiveSettings settings;
        settings.wander.distal_m = 1e-4;
        RecursiveEstimator estimator(paper_model(), start, settings);
        TensionReading reading{spot_of_node(paper_model().cable(), 10), range_N, {}};
        reading.noise.additive_N = 0.1;
        reading.noise.range_N = range_N;
        const auto readings = std::span(&reading, read ? 1u : 0u);
        for (int step = 0; step < 5; ++step) estimator.step({start.displacement_m.front(), 0.0}, readings);
        return estimator.mean_N()[10];
    };
    const double unread_N = mean_after_N(1.0, false);
    EXPECT_EQ(mean_after_N(1.0, true), unread_N);
    EXPECT_GT(mean_after_N(unread_N + 2.0, true), unread_N + 0.5);
}

TEST(RecursiveEstimator, AtANodeItsMomentsAreTheNodesAndBetweenNodesTheMeanIsInterpolated) {
    const CableState start = pretensioned(paper_model().cable());
    RecursiveSettings settings;
    settings.wander.distal_m = 1e-4;
    RecursiveEstimator estimator(paper_model(), start, settings);
    for (int step = 1; step <= 10; ++step) estimator.step({proximal_m(paper_model().cable(), step), 0.0}, {});
    for (int node = 0; node <= 10; ++node) {
        const auto moments = estimator.at(spot_of_node(paper_model().cable(), node));
        EXPECT_NEAR(moments.mean_N, estimator.mean_N()[static_cast<std::size_t>(node)], 1e-12);
        EXPECT_NEAR(moments.deviation_N, estimator.deviation_N()[static_cast<std::size_t>(node)], 1e-12);
    }
    EXPECT_NEAR(estimator.at({4, 0.25}).mean_N, 0.75 * estimator.mean_N()[4] + 0.25 * estimator.mean_N()[5],
                1e-12);
}

}  // namespace
}  // namespace capstan
