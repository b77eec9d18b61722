// The contract of every fusion method of the catalogue.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "fusion_bench.h"

namespace capstan {
namespace {

using test::FusionBench;
using test::Instant;
using test::paper_instant;

const std::vector<std::vector<int>> sensor_sets = {{10},
                                                   {0},
                                                   {5},
                                                   {0, 10},
                                                   {8, 9, 10},
                                                   {0, 1, 9, 10},
                                                   {0, 2, 4, 6, 8, 10},
                                                   {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}};

class EveryFusionMethod : public testing::TestWithParam<FusionMethod> {};

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryFusionMethod, testing::ValuesIn(fusion_methods()),
                         [](const auto& method) { return std::string(method.param.name); });

// How far two neighbouring points of the grid are apart around the truth, which for a blocked distal end lies
// halfway between the two in the middle.
double grid_step_N(const FeasibleCurve& curve) {
    double step_N = 0.0;
    const int middle = curve.points() / 2;
    for (int node = 0; node < curve.nodes(); ++node) {
        const auto along = curve.tension_N(node);
        for (int k = middle - 2; k <= middle; ++k)
            step_N = std::max(step_N, std::abs(along[k + 1] - along[k]));
    }
    return step_N;
}

bool has_the_distal_sensor(const std::vector<int>& sensors) {
    return std::find(sensors.begin(), sensors.end(), 10) != sensors.end();
}

// Methods on the curve are as exact as its grid: within one step of it at every node. And only with a sensor
// at the distal end: should that end slip a little, only a thin layer beside it would know.
TEST_P(EveryFusionMethod, IsExactWithoutNoiseInMassMotion) {
    for (const int sample : test::mass_samples) {
        const Instant instant = paper_instant(sample);
        const FusionBench bench(instant, instant.truth.tension_N, NoiseLevel{}, 1024);
        const bool on_grid = GetParam().knowledge == Knowledge::feasible_curve;
        const double tolerance_N = on_grid ? grid_step_N(bench.curve()) : 1e-12;
        EXPECT_LT(tolerance_N, 0.05) << "or the grid is too coarse to say anything";
        for (const std::vector<int>& sensors : sensor_sets) {
            if (on_grid && !has_the_distal_sensor(sensors)) continue;
            const auto tension_N = bench.fuse(GetParam(), sensors);
            for (int i = 0; i < instant.nodes(); ++i) {
                EXPECT_NEAR(tension_N[i], instant.truth.tension_N[i], tolerance_N)
                    << sensors.size() << " sensors, node " << i << ", sample " << sample;
            }
        }
    }
}

TEST_P(EveryFusionMethod, IsFiniteAndReproducible) {
    for (const int sample : {112, 142, 6, 104}) {
        const Instant instant = paper_instant(sample);
        for (int r = 0; r < 20; ++r) {
            const FusionBench bench(instant, test::noisy_readings(instant, sample, r), test::ten_percent);
            for (const std::vector<int>& sensors : sensor_sets) {
                const auto tension_N = bench.fuse(GetParam(), sensors);
                for (const double node_N : tension_N) ASSERT_TRUE(std::isfinite(node_N));
                ASSERT_EQ(bench.fuse(GetParam(), sensors), tension_N);
            }
        }
    }
}

// Sums in another order: a few units in the last place of 10 N, a thousand times that allowed.
TEST_P(EveryFusionMethod, IsInvariantToTheOrderOfTheSensors) {
    std::mt19937_64 random(1);
    for (const int sample : {142, 6}) {
        const Instant instant = paper_instant(sample);
        for (int r = 0; r < 10; ++r) {
            const FusionBench bench(instant, test::noisy_readings(instant, sample, r), test::ten_percent);
            for (std::vector<int> sensors : sensor_sets) {
                const auto tension_N = bench.fuse(GetParam(), sensors);
                std::shuffle(sensors.begin(), sensors.end(), random);
                const auto shuffled_N = bench.fuse(GetParam(), sensors);
                for (int i = 0; i < instant.nodes(); ++i) ASSERT_NEAR(shuffled_N[i], tension_N[i], 1e-11);
            }
        }
    }
}

TEST_P(EveryFusionMethod, IsFoundByItsNameAndSaysWhatItDoes) {
    const FusionMethod* found = find_fusion_method(GetParam().name);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->fuse, GetParam().fuse);
    EXPECT_FALSE(GetParam().title.empty());
    EXPECT_FALSE(GetParam().meaning.empty());
    EXPECT_FALSE(GetParam().source.empty());
}

TEST(FusionMethods, HaveDifferentNamesAndTitles) {
    std::set<std::string_view> names;
    std::set<std::string_view> titles;
    for (const FusionMethod& method : fusion_methods()) {
        EXPECT_TRUE(names.insert(method.name).second) << method.name;
        EXPECT_TRUE(titles.insert(method.title).second) << method.title;
    }
    EXPECT_EQ(find_fusion_method("not_a_method"), nullptr);
}

// The posterior mean overwrites the likelihood that maximum likelihood reads.
TEST(FusionMethods, MaximumLikelihoodStandsBeforeThePosteriorMean) {
    const auto place = [](std::string_view name) {
        return std::find_if(fusion_methods().begin(), fusion_methods().end(),
                            [&](const FusionMethod& method) { return method.name == name; });
    };
    EXPECT_LT(place("maximum_likelihood"), place("posterior_mean"));
}

TEST(FusionMethods, TheCatalogueHasMethodsOfEveryKindOfKnowledge) {
    std::set<std::string_view> kinds;
    for (const FusionMethod& method : fusion_methods()) kinds.insert(name_of(method.knowledge));
    EXPECT_EQ(kinds, (std::set<std::string_view>{"direction_known", "direction_unknown", "feasible_curve"}));
}

}  // namespace
}  // namespace capstan
