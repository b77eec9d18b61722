#include <gtest/gtest.h>

#include <cmath>

#include "capstan/estimate/modelled_cable.h"
#include "capstan/estimate/tracking.h"
#include "full_model.h"

namespace capstan::estimate {
namespace {

// What a diagnosis would say of a bench with one effect and nothing else.
bench_model::BenchModel model_with(const std::string& effect, std::vector<gap::FittedNumber> numbers) {
    bench_model::BenchModel model = bench_model::full_model();
    model.friction_ratio = {"friction", "", 1.0, {}};
    model.stiffness_ratio = {"stiffness", "", 1.0, {}};
    model.pretension_ratio = {"pretension", "", 1.0, {}};
    model.effects = {{effect, "", std::move(numbers)}};
    model.sensors.clear();
    model.follows.clear();
    model.laws.clear();
    return model;
}

struct Case {
    std::string effect;
    std::vector<gap::FittedNumber> numbers;
};

const std::vector<Case>& cases() {
    static const std::vector<Case> all = {
        {"viscous_friction", {{"drag", "N s/m2", 20.0, {}}}},
        {"stribeck",
         {{"extra_friction", "", 0.15, {}}, {"speed", "m/s", 0.003, {}}, {"memory", "s", 0.04, {}}}}};
    return all;
}

Recording recorded(const bench_model::BenchModel& model) {
    return gap::exact_session(model.numbers(), gap::coarse_twin);
}

// The model alone, without a reading, against what the sensor read. Segments alone leave 0.014 N.
double rms_without_readings_N(const SensedCable& cable) {
    const Cable cut(cable.specification);
    double squares = 0.0;
    double count = 0.0;
    track(cable, {}, {}, {.members = 8}, [&](const TrackedSample& at) {
        const double mean_N = at.at(spot_at(cut, cable.channels[0].position_m)).mean_N;
        squares += std::pow(mean_N - cable.runs[at.run].reading_N[0][at.sample], 2);
        ++count;
    });
    return std::sqrt(squares / count);
}

TEST(RateFrictionOfAModel, PredictsASensorOfABenchThatHasIt) {
    for (const Case& each : cases()) {
        const bench_model::BenchModel model = model_with(each.effect, each.numbers);
        const ModelledCables modelled = modelled_cables(recorded(model), model, 24);
        ASSERT_EQ(modelled.cables.size(), 1u);
        EXPECT_TRUE(modelled.not_used.empty()) << each.effect;
        SensedCable without = modelled.cables[0];
        without.rate_friction = {};
        const double known_N = rms_without_readings_N(modelled.cables[0]);
        const double unknown_N = rms_without_readings_N(without);
        EXPECT_LT(known_N, 0.5 * unknown_N) << each.effect;
    }
}

// The band without readings is as wide as the interval of the effect's number leaves open.
TEST(RateFrictionOfAModel, IsUncertainWhereItsNumberHasAnInterval) {
    for (Case each : cases()) {
        const double value = each.numbers[0].value;
        each.numbers[0].interval = gap::FittedInterval{0.8 * value, 1.2 * value};
        const bench_model::BenchModel model = model_with(each.effect, each.numbers);
        const ModelledCables modelled = modelled_cables(recorded(model), model, 24);
        const SensedCable& cable = modelled.cables[0];
        ASSERT_EQ(cable.uncertain.size(), 1u) << each.effect;
        const double ratio =
            each.effect == "stribeck" ? cable.uncertain[0].stribeck_ratio : cable.uncertain[0].viscous_ratio;
        EXPECT_NEAR(ratio, 1.0 + 0.4 / (2.0 * 1.96), 1e-4);
        double widest_N = 0.0;
        track(cable, {}, {}, {.members = 8},
              [&](const TrackedSample& at) { widest_N = std::max(widest_N, at.at_node(12).deviation_N); });
        EXPECT_GT(widest_N, 0.005) << each.effect;
    }
}

}  // namespace
}  // namespace capstan::estimate
