#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <set>

#include "capstan/cable/invalid_input.h"
#include "capstan/storage/study_store.h"
#include "capstan/storage/world_store.h"
#include "capstan/worlds/sensor_places.h"
#include "capstan/worlds/stored_worlds.h"

namespace capstan {
namespace {

// A short study of an arm with a moved far end.
StudyPlan arm_plan(int worlds = 40) {
    StudyPlan plan;
    plan.name = "arm";
    plan.seed = 11;
    plan.repetitions = worlds;
    plan.transmission.cable = {.curvature = {{0.4, straight}, {0.2, 0.12}, {0.2, straight}, {0.2, 0.08}},
                               .segments = 10,
                               .axial_stiffness_N = 9000.0,
                               .dynamic_friction = 0.12,
                               .static_friction = 0.16,
                               .pretension_N = 15.0};
    plan.motion.proximal = {.kind = EndKind::position, .amplitude = 0.002, .frequency_Hz = 1.0};
    plan.motion.distal.kind = EndKind::position;
    plan.motion.sample_rate_Hz = 100.0;
    plan.motion.samples = 80;
    plan.uncertainty.is_stated = true;
    plan.uncertainty.far_end_range_m = 0.001;
    plan.uncertainty.members = 32;
    plan.layout_families = {"even", "distal", "both"};
    plan.sensor_counts = {1, 2, 3};
    plan.noise_levels = {{"3 %", {.multiplicative_ratio = 0.03, .additive_N = 0.1}}};
    plan.worthwhile_gain_N = 0.02;
    return plan;
}

bool same(const Expected& a, const Expected& b) {
    return a.candidate == b.candidate && a.objective.value_N == b.objective.value_N &&
           a.error_95_N == b.error_95_N;
}

void expect_the_same_answer(const WorldAnswer& a, const WorldAnswer& b) {
    EXPECT_EQ(a.recommended, b.recommended);
    EXPECT_TRUE(same(a.no_sensor, b.no_sensor));
    ASSERT_EQ(a.prices.size(), b.prices.size());
    for (std::size_t k = 0; k < a.prices.size(); ++k) {
        EXPECT_TRUE(same(a.prices[k].expected, b.prices[k].expected)) << k;
        EXPECT_EQ(a.prices[k].ties, b.prices[k].ties);
    }
    EXPECT_EQ(a.further_gain.value_N, b.further_gain.value_N);
    EXPECT_EQ(a.grid.error_N, b.grid.error_N);
}

TEST(SensorChoice, IsTheSameForEveryNumberOfThreads) {
    expect_the_same_answer(run_worlds(arm_plan(), {.jobs = 1}), run_worlds(arm_plan(), {.jobs = 3}));
}

TEST(SensorChoice, WorldsAreThoseOfTheSeedAndOfTheTruth) {
    const StudyPlan plan = arm_plan();
    const World world = draw_world(world_question(plan), 3);
    StudyPlan other = plan;
    other.seed = 12;
    EXPECT_NE(draw_world(world_question(other), 3).factors[0].log_friction, world.factors[0].log_friction);
    StudyPlan rough = plan;
    rough.truth.friction_ratio = 1.5;
    const World about_truth = draw_world(world_question(rough), 3);
    EXPECT_EQ(about_truth.factors[0].log_friction,
              world.factors[0].log_friction);  // the draw is about another centre
    EXPECT_NE(about_truth.tensions_N(60).back(), world.tensions_N(60).back());
    StudyPlan soft = plan;
    soft.transmission.cable.segments = 4;
    const std::size_t creep = [] {
        std::size_t at = 0;
        while (effect_catalogue()[at].name != "creep") ++at;
        return at;
    }();
    soft.truth.effects[creep][0] = 0.5;
    EXPECT_TRUE(draw_world(world_question(soft), 3).has_effects);
    soft.uncertainty.truth_probability = 0.0;
    EXPECT_FALSE(draw_world(world_question(soft), 3).has_effects);
}

TEST(SensorChoice, NothingThatIsRecommendedIsWorseThanNoSensor) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        StudyPlan plan = arm_plan();
        plan.seed = seed;
        const WorldAnswer answer = run_worlds(plan, {});
        ASSERT_TRUE(answer.recommended);
        EXPECT_LT(answer.best().expected.objective.value_N, answer.no_sensor.objective.value_N);
        EXPECT_GT(answer.gain_over_none.low_N, 0.0);
    }
}

TEST(SensorChoice, ASensorThatTellsNothingIsNotRecommended) {
    StudyPlan plan = arm_plan();
    plan.noise_levels.front().level = {.multiplicative_ratio = 50.0, .additive_N = 5000.0};
    const WorldAnswer answer = run_worlds(plan, {});
    EXPECT_FALSE(answer.recommended);
    EXPECT_NE(sentence_of(plan, answer).find("No set of sensors is better than none"), std::string::npos);
}

// What one more sensor does to the squared error is the law that a Bayesian estimator obeys.
TEST(SensorChoice, AFurtherSensorNeverRaisesTheSquaredError) {
    ErrorTable table(arm_plan(), {});
    const auto& candidates = table.candidates();
    constexpr int worlds = 60;
    std::vector<int> all;
    for (int k = 0; k < static_cast<int>(candidates.size()); ++k) all.push_back(k);
    table.fill(Condition::as_stated, all, 0, worlds, "test");
    int pairs = 0;
    for (int a = 0; a < static_cast<int>(candidates.size()); ++a) {
        for (int b = 0; b < static_cast<int>(candidates.size()); ++b) {
            const auto& fewer = candidates[a].sensors;
            const auto& more = candidates[b].sensors;
            if (fewer.size() >= more.size() ||
                !std::includes(more.begin(), more.end(), fewer.begin(), fewer.end()))
                continue;
            ++pairs;
            double mean = 0.0, squares = 0.0, before = 0.0;
            for (int w = 0; w < worlds; ++w) {
                const double rise = table.at(Condition::as_stated, b, w).mean_square_N2 -
                                    table.at(Condition::as_stated, a, w).mean_square_N2;
                mean += rise / worlds;
                squares += rise * rise / worlds;
                before += table.at(Condition::as_stated, a, w).mean_square_N2 / worlds;
            }
            const double error = std::sqrt((squares - mean * mean) / (worlds - 1));
            EXPECT_LT(mean, std::max(3.0 * error, 0.02 * before)) << a << " to " << b;
        }
    }
    EXPECT_GT(pairs, 10);
}

TEST(SensorChoice, TheBandHoldsTheTruthAsOftenAsItSays) {
    ErrorTable table(arm_plan(), {});
    constexpr int worlds = 60;
    const std::vector<int> some = {0, 1, static_cast<int>(table.candidates().size()) - 1};
    table.fill(Condition::as_stated, some, 0, worlds, "test");
    for (const int candidate : some) {
        double covered = 0.0;
        for (int w = 0; w < worlds; ++w)
            covered += table.at(Condition::as_stated, candidate, w).covered_fraction / worlds;
        EXPECT_GT(covered, 0.90) << candidate;
        EXPECT_LT(covered, 0.98) << candidate;
    }
}

TEST(SensorChoice, ObeysEveryConstraint) {
    StudyPlan plan = arm_plan(20);
    plan.placement.search = ComparedSets::all;
    plan.placement.max_sensors = 3;
    plan.placement.forbidden_m = {0.35, 0.65};
    plan.placement.required_m = {1.0};
    plan.placement.minimum_spacing_m = 0.25;
    const auto offers = sensor_offers(plan);
    const auto candidates = candidates_of(plan, offers);
    ASSERT_GT(candidates.size(), 3U);
    EXPECT_TRUE(candidates.front().sensors.empty());
    for (std::size_t k = 1; k < candidates.size(); ++k) {
        const auto& sensors = candidates[k].sensors;
        EXPECT_LE(sensors.size(), 3U);
        bool has_required = false;
        for (std::size_t s = 0; s < sensors.size(); ++s) {
            const double place_m = offers[static_cast<std::size_t>(sensors[s])].place_m;
            EXPECT_TRUE(place_m < 0.35 || place_m > 0.65);
            has_required = has_required || std::abs(place_m - 1.0) < 1e-9;
            if (s > 0) {
                EXPECT_GE(place_m - offers[static_cast<std::size_t>(sensors[s - 1])].place_m, 0.25 - 1e-6);
            }
        }
        EXPECT_TRUE(has_required);
    }
}

TEST(SensorChoice, ConstraintsThatNoSetSatisfiesAreRefused) {
    StudyPlan plan = arm_plan(20);
    plan.placement.required_m = {0.5};
    plan.placement.forbidden_m = {0.4, 0.6};
    EXPECT_THROW(candidates_of(plan, sensor_offers(plan)), InvalidInput);
}

TEST(SensorChoice, EvenMeansFromEndToEnd) {
    StudyPlan plan = arm_plan(20);
    plan.transmission.cable.segments = 15;
    plan.layout_families = {"even"};
    plan.sensor_counts = {9};
    const auto offers = sensor_offers(plan);
    const auto candidates = candidates_of(plan, offers);
    ASSERT_EQ(candidates.size(), 2U);
    const auto& sensors = candidates[1].sensors;
    ASSERT_EQ(sensors.size(), 9U);
    EXPECT_EQ(offers[static_cast<std::size_t>(sensors.front())].place_m, 0.0);
    EXPECT_NEAR(offers[static_cast<std::size_t>(sensors.back())].place_m, 1.0, 1e-12);
    for (std::size_t k = 1; k < sensors.size(); ++k) EXPECT_LE(sensors[k] - sensors[k - 1], 2);
}

TEST(SensorChoice, EvenChoosesByPlaceWhereNodesAreNotEvenlySpread) {
    StudyPlan plan = arm_plan(20);
    plan.sensors = {{SensorKind::tension, {0.0, 0.1, 0.2, 0.55, 0.9, 1.0}, {0.03, 0.1, 0.0, 0.0}, 1.0}};
    plan.layout_families = {"even"};
    const auto places_of = [&](int count) {
        plan.sensor_counts = {count};
        const auto offers = sensor_offers(plan);
        std::vector<double> places_m;
        const Candidate chosen = candidates_of(plan, offers).at(1);
        for (const int sensor : chosen.sensors)
            places_m.push_back(offers[static_cast<std::size_t>(sensor)].place_m);
        return places_m;
    };
    EXPECT_EQ(places_of(1), (std::vector<double>{0.55}));
    EXPECT_EQ(places_of(3), (std::vector<double>{0.0, 0.55, 1.0}));
    EXPECT_EQ(places_of(4), (std::vector<double>{0.0, 0.2, 0.55, 1.0}));
    EXPECT_EQ(places_of(6), (std::vector<double>{0.0, 0.1, 0.2, 0.55, 0.9, 1.0}));
}

// With nodes at both ends of every bend and at the sensors' places, readings are tensions of nodes.
TEST(SensorChoice, NodesLieAtBendsAndSensorsOnEveryGrid) {
    StudyPlan plan = arm_plan(20);
    plan.sensors = {{SensorKind::tension, {0.0, 0.33, 0.97}, {0.0, 1e-12, 0.0, 0.0}, 1.0}};
    plan.transmission.cut = CableCut::at_bends;
    place_nodes(plan);
    ASSERT_TRUE(problems_of(plan).empty());
    for (const int pieces : {1, 2, 4}) {
        const WorldQuestion question = world_question(plan, pieces);
        const Cable cable(question.cable.nominal());
        ASSERT_EQ(cable.segments(), 10 * pieces);
        for (const double place_m : {0.4, 0.6, 0.8, 0.33, 0.97})
            EXPECT_NEAR(cable.node_position_m(cable.nearest_node(place_m)), place_m, 1e-12);
        const World world = draw_world(question, 2);
        for (std::size_t s = 0; s < question.offers.size(); ++s) {
            const auto node = static_cast<std::size_t>(cable.nearest_node(question.offers[s].place_m));
            EXPECT_NEAR(world.sensed[40 * question.offers.size() + s], world.tensions_N(40)[node], 1e-9);
        }
    }
}

TEST(SensorChoice, TooFewSegmentsForBendsAndSensorsAreRefusedWithTheNumberNeeded) {
    StudyPlan plan = arm_plan(20);
    plan.sensors = {{SensorKind::tension, {0.0, 0.33, 0.97}, {0.0, 0.1, 0.0, 0.0}, 1.0}};
    plan.transmission.cut = CableCut::at_bends;
    plan.transmission.cable.segments = 5;
    place_nodes(plan);
    const auto problems = problems_of_values(plan);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_EQ(problems.front().key, "transmission.segments");
    EXPECT_NE(problems.front().message.find("need at least 6 segments"), std::string::npos);
}

// Where nodes lie closer together they must not count for more of the cable.
TEST(SensorChoice, TheErrorIsAMeanOverTheLengthAndNotOverNodes) {
    StudyPlan plan = arm_plan(20);
    plan.transmission.cable.segments = 40;
    const WorldQuestion even = world_question(plan);
    for (double at_m = 0.01; at_m < 0.2; at_m += 0.01) plan.transmission.cable.node_places_m.push_back(at_m);
    const WorldQuestion crowded = world_question(plan);
    const auto error_N = [](const WorldQuestion& question) {
        double sum_N = 0.0;
        for (std::uint32_t index = 0; index < 10; ++index)
            sum_N += filter_error(question, question.belief, draw_world(question, index),
                                  ensemble_draws(question, index), {})
                         .mean_abs_N;
        return sum_N / 10.0;
    };
    EXPECT_NEAR(error_N(crowded), error_N(even), 0.03 * error_N(even));
}

TEST(SensorChoice, SensorsOfOtherKindsComeWithEverySet) {
    StudyPlan plan = arm_plan(20);
    plan.sensors = {{SensorKind::tension, {0.0, 0.5, 1.0}, {0.03, 0.1, 0.0, 0.0}, 1.0},
                    {SensorKind::load_displacement, {}, {0.0, 1e-4, 0.0, 0.0}, 2.5}};
    const auto offers = sensor_offers(plan);
    ASSERT_EQ(offers.size(), 4U);
    int with_encoder = 0;
    for (const Candidate& candidate : candidates_of(plan, offers)) {
        const bool has =
            std::find(candidate.sensors.begin(), candidate.sensors.end(), 3) != candidate.sensors.end();
        with_encoder += has ? 1 : 0;
        EXPECT_DOUBLE_EQ(candidate.price, (candidate.count() - (has ? 1 : 0)) * 1.0 + (has ? 2.5 : 0.0));
    }
    EXPECT_GT(with_encoder, 2);
}

// From their own estimates and with the nominal cable, they know neither friction nor the far end.
TEST(SensorChoice, ThePapersFourMethodsRunOverTimeAndErrMoreThanTheFilter) {
    const WorldAnswer answer = run_worlds(arm_plan(), {});
    ASSERT_EQ(answer.paper.size(), 4U);
    EXPECT_EQ(answer.paper[2].condition, Condition::paper_w_mean);
    for (const PaperComparison& each : answer.paper) {
        EXPECT_TRUE(std::isfinite(each.error.value_N));
        EXPECT_GT(each.error.value_N, answer.best().expected.objective.value_N) << name_of(each.condition);
    }
    EXPECT_NE(answer.paper[0].error.value_N, answer.paper[2].error.value_N);
}

TEST(SensorChoice, ASensorWithMoreNoiseWeighsLess) {
    StudyPlan plan = arm_plan();
    plan.sensors = {{SensorKind::tension, {1.0}, {0.03, 0.1, 0.0, 0.0}, 1.0},
                    {SensorKind::tension, {1.0}, {0.5, 5.0, 0.0, 0.0}, 1.0}};
    const WorldQuestion question = world_question(plan);
    EXPECT_GT(paper_weight(question, 0), 1.2 * paper_weight(question, 1));
}

// Common to all candidates, and nothing but a stretch of the log.
TEST(SensorChoice, EachWorldMovesTheFarEndByAnotherStretchOfTheLog) {
    StudyPlan plan = arm_plan();
    plan.uncertainty.far_end = FarEndKind::recorded;
    for (int k = 0; k < 400; ++k)
        plan.uncertainty.far_end_samples_m.push_back(1e-6 * k * k);  // each stretch has a slope of its own
    plan.sensors = {{SensorKind::load_displacement, {}, {0.0, 1e-12, 0.0, 0.0}, 1.0}};
    const WorldQuestion question = world_question(plan);
    std::set<int> starts;
    for (std::uint32_t world = 0; world < 50; ++world) {
        const World drawn = draw_world(question, world);
        const double first_m = drawn.sensed[0];  // 1e-6 (2 k + 1)
        const int start = static_cast<int>(std::lround((first_m / 1e-6 - 1.0) / 2.0));
        starts.insert(start);
        for (int sample = 0; sample < drawn.samples(); ++sample) {
            const double moved = start + sample + 1.0;
            EXPECT_NEAR(drawn.sensed[static_cast<std::size_t>(sample)],
                        1e-6 * (moved * moved - start * start), 1e-10);
        }
    }
    EXPECT_GT(starts.size(), 30U);
    EXPECT_GE(*starts.begin(), 0);
    EXPECT_LT(*starts.rbegin(), 400 - plan.motion.samples);
}

// What is assumed has the range of the log; with a log of one stretch all worlds share it.
TEST(SensorChoice, WithARecordedFarEndSensorsHelpAndTheBandIsHonest) {
    StudyPlan plan = arm_plan();
    plan.uncertainty.far_end = FarEndKind::recorded;
    for (int k = 0; k < 3000; ++k)
        plan.uncertainty.far_end_samples_m.push_back(0.0005 *
                                                     (std::sin(0.043 * k) + std::sin(0.071 * k + 1.0)));
    const WorldAnswer answer = run_worlds(plan, {});
    ASSERT_TRUE(answer.recommended);
    EXPECT_GT(answer.best().expected.covered_fraction, 0.90);
}

class StoredWorlds : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("capstan_worlds_") +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    storage::Database open(const std::string& name) {
        return storage::Database::open_or_create(folder_ / name);
    }

    std::filesystem::path folder_;
};

TEST_F(StoredWorlds, SayTheSameAsARunWithoutADatabase) {
    storage::Database database = open("a.db");
    const std::int64_t id = begin_worlds(database, arm_plan(), "test");
    const WorldAnswer stored = run_worlds(database, id, arm_plan(), {});
    expect_the_same_answer(stored, run_worlds(arm_plan(), {}));
    expect_the_same_answer(stored, run_worlds(database, id, arm_plan(), {}));  // read back
    const auto recommendation = storage::read_world_recommendation(database, id);
    ASSERT_TRUE(recommendation);
    EXPECT_EQ(recommendation->expected_error_N, stored.best().expected.objective.value_N);
    EXPECT_EQ(storage::load_study(database, id).study.status, "complete");
}

TEST_F(StoredWorlds, EndWithTheSameBitsAfterEveryStop) {
    storage::Database complete_study = open("complete.db");
    const std::int64_t complete_id = begin_worlds(complete_study, arm_plan(), "test");
    run_worlds(complete_study, complete_id, arm_plan(), {});
    storage::Database stopped = open("stopped.db");
    const std::int64_t id = begin_worlds(stopped, arm_plan(), "test");
    int stops = 0;
    for (bool complete = false; !complete;) {
        std::atomic<bool> stop = false;
        int blocks = 0;
        try {
            run_worlds(stopped, id, arm_plan(),
                       {.on_progress = [&](const TableProgress&) { stop = ++blocks >= 9; }, .stop = &stop});
            complete = true;
        } catch (const TableStopped&) {
            ++stops;
        }
        ASSERT_LT(stops, 1000);
    }
    EXPECT_GT(stops, 1);
    EXPECT_EQ(storage::read_world_errors(stopped, id),
              storage::read_world_errors(complete_study, complete_id));
    EXPECT_EQ(storage::read_world_recommendation(stopped, id),
              storage::read_world_recommendation(complete_study, complete_id));
}

}  // namespace
}  // namespace capstan
