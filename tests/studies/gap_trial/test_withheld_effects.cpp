#include <gtest/gtest.h>

#include <cmath>

#include "capstan/gap_trial/trial_plan.h"
#include "sample_session.h"

namespace capstan::gap_trial {
namespace {

std::vector<EffectMaker> all_makers() {
    std::vector<EffectMaker> all = catalogue_effects();
    all.insert(all.end(), wrong_parameters().begin(), wrong_parameters().end());
    all.insert(all.end(), foreign_causes().begin(), foreign_causes().end());
    return all;
}

std::map<std::string, double> spans(const TrialBench& bench) {
    std::map<std::string, double> spans;
    for (const std::string& channel : bench.channels()) spans[channel] = 1.0;
    return spans;
}

class EveryEffect : public testing::TestWithParam<BenchKind> {
  protected:
    void SetUp() override {
        TrialStream draws(1, 1, DrawTopic::bench);
        bench_ = make_trial_bench(GetParam(), 1.0, draws);
        runs_ = sample_session(bench_);
        spans_ = spans(bench_);
        none_ = sensed_with(bench_, runs_, {});
    }

    SensedSession with(const WithheldEffect& effect, double size) const {
        TrueEffects effects;
        effect.apply(effects, size);
        return sensed_with(bench_, runs_, effects);
    }
    // Each effect that fits the bench, drawn once.
    template <typename Body>
    void for_each_effect(const Body& body) {
        TrialStream draws(7, 1, DrawTopic::effect);
        for (const EffectMaker& maker : all_makers()) {
            if (!fits(maker, bench_, runs_)) continue;
            const WithheldEffect effect = maker.draw({bench_, runs_, spans_}, draws);
            SCOPED_TRACE(effect.kind);
            EXPECT_EQ(effect.effect, maker.effect);
            body(effect);
        }
    }

    TrialBench bench_;
    std::vector<TrialRun> runs_;
    std::map<std::string, double> spans_;
    SensedSession none_;
};

TEST_P(EveryEffect, AtSizeZeroGivesTheSameBitsAsNone) {
    for_each_effect([&](const WithheldEffect& effect) { EXPECT_EQ(with(effect, 0.0), none_); });
}

TEST_P(EveryEffect, ChangesTheRecordingAndStaysFinite) {
    for_each_effect([&](const WithheldEffect& effect) {
        // A rounding step shows when the reading is rounded, with the noise.
        if (effect.effect == "sensor_quantization") return;
        const SensedSession changed = with(effect, std::min(3.0 * effect.first_size, effect.largest_size));
        EXPECT_NE(changed, none_);
        for (const SensedRun& run : changed) {
            for (const std::vector<double>& channel : run) {
                for (const double value : channel) ASSERT_TRUE(std::isfinite(value));
            }
        }
    });
}

INSTANTIATE_TEST_SUITE_P(Benches, EveryEffect,
                         testing::Values(BenchKind::uniform_wide, BenchKind::single_cable),
                         [](const auto& kind) { return bench_kind_name(kind.param); });

TEST(SensorQuantization, ReadsIntegerMultiplesOfTheStep) {
    TrialStream bench_draws(1, 1, DrawTopic::bench);
    const TrialBench bench = make_trial_bench(BenchKind::uniform_wide, 1.0, bench_draws);
    const SensedRun run(bench.channels().size(), {0.11, 0.26, -0.9});
    TrialStream noise(1, 1, DrawTopic::noise);
    std::map<std::string, TrueSensorFault> faults;
    faults["load_torque"].step = 0.25;
    const SensedRun logged = with_noise(bench, run, faults, noise);
    for (const double value : logged[3]) EXPECT_EQ(value / 0.25, std::round(value / 0.25));
}

TEST(Catalogue, EveryEffectHasAFamilyAndForeignCausesAreDiverse) {
    for (const EffectMaker& maker : catalogue_effects()) EXPECT_NE(effect_family(maker.effect), maker.effect);
    for (const EffectMaker& maker : wrong_parameters()) EXPECT_NE(effect_family(maker.effect), maker.effect);
    EXPECT_GE(foreign_causes().size(), 6U);
    EXPECT_EQ(effect_family("unknown"), "unknown");
}

TEST(Visibility, ChangesThatNominalNumbersExplainAreInvisible) {
    TrialStream draws(1, 1, DrawTopic::bench);
    const TrialBench bench = make_trial_bench(BenchKind::uniform_wide, 1.0, draws);
    const std::vector<TrialRun> runs = sample_session(bench);
    const Baseline baseline = make_baseline(bench, runs, {}, sensed_with(bench, runs, {}));
    const auto seen = [&](double friction_ratio) {
        TrueEffects effects;
        effects.friction_ratio = friction_ratio;
        return visibility(bench, runs, baseline, sensed_with(bench, runs, effects)).ratio;
    };
    EXPECT_EQ(visibility(bench, runs, baseline, baseline.sensed).ratio, 0.0);
    EXPECT_LT(seen(1.02), 1.0);  // what is left is how fronts go from lump to lump
    EXPECT_GT(seen(1.3), 3.0);
}

TEST(FindSize, ReachesAVisibilityInTheRange) {
    TrialStream draws(1, 1, DrawTopic::bench);
    const TrialBench bench = make_trial_bench(BenchKind::uniform_wide, 1.0, draws);
    const std::vector<TrialRun> runs = sample_session(bench);
    const TrueEffects none;
    const std::vector<TrueRun> truth = run_session(bench, runs, none);
    const Baseline baseline = make_baseline(bench, runs, none, sense_session(bench, truth, none));
    const std::map<std::string, double> one = spans(bench);
    TrialStream effect_draws(1, 1, DrawTopic::effect);
    const WithheldEffect viscous = catalogue_effects().front().draw({bench, runs, one}, effect_draws);
    const auto sized =
        find_size({bench, runs, none, truth, baseline}, viscous, range_of(Severity::strong), 6.0);
    ASSERT_TRUE(sized.has_value());
    TrueEffects effects;
    viscous.apply(effects, sized->size);
    const Visibility seen = visibility(bench, runs, baseline, sensed_with(bench, runs, effects));
    EXPECT_EQ(seen.ratio, sized->visibility.ratio);
    EXPECT_GE(seen.ratio, 4.0);
    EXPECT_LE(seen.ratio, 10.0);
    WithheldEffect feeble = viscous;
    feeble.largest_size = feeble.first_size = 1e-3;
    EXPECT_FALSE(
        find_size({bench, runs, none, truth, baseline}, feeble, range_of(Severity::mild), 2.0).has_value());
}

}  // namespace
}  // namespace capstan::gap_trial
