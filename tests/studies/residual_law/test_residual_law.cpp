#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "capstan/residual_law/residual_law.h"

namespace capstan::residual_law {
namespace {

/// What is left at one sample of a run.
struct Moment {
    double motion_rad, lagging, load_Nm, time_s;
};

struct Session {
    int runs = 5;
    double noise_Nm = 2e-3;
    double correlation = 0.0;  ///< of the noise, from sample to sample
    int seed = 1;
};

constexpr double friction_path_rad = 0.06;

// Runs of 8 s at 50 Hz under different loads; `structure` is in the residual besides noise. `lagging`: -1 to
// 1 within the friction's path after a reversal.
std::vector<ResidualRun> residuals(const Session& session,
                                   const std::function<double(const Moment&)>& structure) {
    std::mt19937 draw(static_cast<unsigned>(session.seed));
    std::normal_distribution<double> normal;
    std::vector<ResidualRun> runs;
    for (int number = 0; number < session.runs; ++number) {
        ResidualRun run;
        run.sample_period_s = 0.02;
        run.first_scored = 50;
        run.session_start_s = 20.0 * number;
        double lagging_rad = 0.0;
        double noise = 0.0;
        for (int sample = 0; sample < 400; ++sample) {
            const double time_s = run.sample_period_s * sample;
            const double phase = 2.0 * std::numbers::pi * time_s * (0.3 + 0.05 * number);
            const double angle_rad = 0.6 * std::sin(phase) + 0.1 * std::sin(2.7 * phase);
            const double half_rad = 0.5 * friction_path_rad;
            if (sample > 0)
                lagging_rad = std::clamp(lagging_rad + angle_rad - run.motion.back(), -half_rad, half_rad);
            const double load_Nm = 0.05 * (number + 1) * (1.0 + 0.1 * std::sin(0.4 * phase));
            noise = session.correlation * noise +
                    std::sqrt(1.0 - session.correlation * session.correlation) * normal(draw);
            run.motion.push_back(angle_rad);
            run.load.push_back(load_Nm);
            run.residual.push_back(structure({angle_rad, lagging_rad / half_rad, load_Nm, time_s}) +
                                   session.noise_Nm * noise);
        }
        runs.push_back(std::move(run));
    }
    return runs;
}

double rms_left(const ResidualLaw& law, const std::vector<ResidualRun>& runs) {
    double squares = 0.0;
    double samples = 0.0;
    for (const ResidualRun& run : runs) {
        const std::vector<double> predicted = law.predict(run);
        for (std::size_t k = run.first_scored; k < predicted.size(); ++k, ++samples)
            squares += std::pow(run.residual[k] - predicted[k], 2);
    }
    return std::sqrt(squares / samples);
}

double friction_that_grows_with_load(const Moment& at) {
    return 0.1 * at.load_Nm * at.lagging;
}

TEST(ResidualLaw, FindsFrictionThatGrowsWithTheLoadAndSaysSo) {
    const ResidualLaw law = fit_residual_law(residuals({}, friction_that_grows_with_load), {});
    ASSERT_EQ(law.terms.size(), 1u);
    const Feature& found = law.terms.front().features.front();
    EXPECT_EQ(found.kind, FeatureKind::friction);
    EXPECT_TRUE(found.times_load);
    EXPECT_NEAR(2.0 * found.parameter, friction_path_rad, 0.02);
    // At the largest load, 0.275 N m; its path is one of a few, which costs a few percent.
    EXPECT_NEAR(law.terms.front().size, 0.1 * law.scales.load, 2e-3);
    EXPECT_LE(std::abs(law.terms.front().size - 0.1 * law.scales.load), law.terms.front().half_width + 1e-3);
    EXPECT_NE(
        law.terms.front().words.find("in proportion to the load, which follows the direction of motion"),
        std::string::npos)
        << law.terms.front().words;
}

TEST(ResidualLaw, HoldsOnRunsThatItWasNotFittedTo) {
    const ResidualLaw law = fit_residual_law(residuals({}, friction_that_grows_with_load), {});
    const std::vector<ResidualRun> fresh = residuals({.seed = 2}, friction_that_grows_with_load);
    EXPECT_LT(rms_left(law, fresh), 2.5e-3);  // noise: 2e-3
    EXPECT_GT(rms_left({}, fresh), 1.2e-2);   // without the law
    EXPECT_NEAR(law.left_out_rms, rms_left(law, fresh), 3e-4);
}

TEST(ResidualLaw, FindsAWaveOfThePositionWithItsPeriod) {
    const double period_rad = 0.23;
    const ResidualLaw law = fit_residual_law(
        residuals({},
                  [&](const Moment& at) {
                      return 5e-3 * std::sin(2.0 * std::numbers::pi * at.motion_rad / period_rad + 0.7);
                  }),
        {});
    ASSERT_FALSE(law.terms.empty());
    EXPECT_EQ(law.terms.front().features.front().kind, FeatureKind::wave_sine);
    EXPECT_NEAR(law.terms.front().features.front().parameter, period_rad, 0.02 * period_rad);
    EXPECT_NEAR(law.terms.front().size, 5e-3, 5e-4);
}

TEST(ResidualLaw, CallsAConstantAConstantAndNoDrift) {
    const ResidualLaw constant = fit_residual_law(residuals({}, [](const Moment&) { return -0.01; }), {});
    ASSERT_EQ(constant.terms.size(), 1u);
    EXPECT_EQ(constant.terms.front().words.substr(0, 22), "a constant torque of -");
    EXPECT_NEAR(constant.terms.front().size, -0.01, 5e-4);
}

TEST(ResidualLaw, IsNotRefusedByARunWhoseLoadNoOtherRunComesNear) {
    // Without the first run a friction and its growth with the load cannot be distinguished, so that its
    // prediction is an extrapolation. A run in between is met by the law of all three.
    const auto session_with = [](const std::vector<double>& loads_Nm, int seed) {
        std::vector<ResidualRun> runs = residuals({.runs = static_cast<int>(loads_Nm.size()), .seed = seed},
                                                  [](const Moment& at) { return 0.02 * at.lagging; });
        for (std::size_t run = 0; run < runs.size(); ++run) {
            for (std::size_t k = 0; k < runs[run].load.size(); ++k) {
                runs[run].load[k] = loads_Nm[run];
                runs[run].residual[k] *= 1.0 - loads_Nm[run] / 0.06;  // none at 0.06 N m
            }
        }
        return runs;
    };
    const ResidualLaw law = fit_residual_law(session_with({0.01, 0.1, 0.101}, 1), {});
    ASSERT_TRUE(law.holds());
    const std::vector<ResidualRun> between = session_with({0.03}, 2);
    EXPECT_LT(rms_left(law, between), 0.5 * rms_left({}, between));
}

TEST(ResidualLaw, OfNoiseIsNothing) {
    for (const int runs : {1, 2, 3, 5}) {
        int found = 0;
        for (int seed = 1; seed <= 20; ++seed) {
            for (const double correlation : {0.0, 0.9}) {
                const Session session{.runs = runs, .correlation = correlation, .seed = seed};
                found += fit_residual_law(residuals(session, [](const Moment&) { return 0.0; }), {}).holds();
            }
        }
        EXPECT_LE(found, 2) << "of 40 sessions of " << runs << " runs";
    }
}

TEST(ResidualLaw, UsesTheHistoryOfTheMotionWhereNoFewTermsDo) {
    // A friction that builds up along many paths at once, as spread-out stiction does.
    std::vector<ResidualRun> runs = residuals({}, [](const Moment&) { return 0.0; });
    for (ResidualRun& run : runs) {
        for (const double path_rad : {0.015, 0.04, 0.1, 0.2, 0.35}) {
            double held = 0.0;
            for (std::size_t k = 1; k < run.motion.size(); ++k) {
                held = std::clamp(held + run.motion[k] - run.motion[k - 1], -0.5 * path_rad, 0.5 * path_rad);
                run.residual[k] += 0.01 * held / path_rad * (1.0 + 8.0 * run.load[k]);
            }
        }
    }
    const ResidualLaw law = fit_residual_law(runs, {});
    EXPECT_GT(law.removed_fraction, 0.85);
    EXPECT_LE(*law.removed_low, law.removed_fraction);
}

TEST(ResidualLaw, HasABandThatHoldsNineteenOfTwentySamplesOfFreshRuns) {
    const ResidualLaw law = fit_residual_law(residuals({}, friction_that_grows_with_load), {});
    int inside = 0;
    int samples = 0;
    for (const ResidualRun& run : residuals({.seed = 3}, friction_that_grows_with_load)) {
        const std::vector<double> predicted = law.predict(run);
        for (std::size_t k = run.first_scored; k < predicted.size(); ++k, ++samples)
            inside += std::abs(run.residual[k] - predicted[k]) <= law.band ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(inside) / samples, 0.95, 0.015);
}

TEST(ResidualLaw, IsFoundInPartsOfTheOnlyRun) {
    const ResidualLaw law =
        fit_residual_law(residuals({.runs = 1}, [](const Moment& at) { return 0.01 * at.lagging; }), {});
    ASSERT_FALSE(law.terms.empty());
    EXPECT_EQ(law.terms.front().features.front().kind, FeatureKind::friction);
}

TEST(ResidualLaw, OfChannelsWithoutALoadHasNoTermOfTheLoad) {
    std::vector<ResidualRun> runs = residuals({}, [](const Moment& at) { return 0.01 * at.lagging; });
    for (ResidualRun& run : runs) run.load.clear();
    const ResidualLaw law = fit_residual_law(runs, {});
    ASSERT_FALSE(law.terms.empty());
    for (const WeightedFeature& each : law.weights) EXPECT_FALSE(each.feature.times_load);
}

TEST(ResidualLaw, IsNothingWithoutSamples) {
    EXPECT_FALSE(fit_residual_law({}, {}).holds());
    ResidualRun brief;
    brief.motion = brief.residual = {0.0, 0.1};
    brief.sample_period_s = 0.01;
    brief.first_scored = 2;
    EXPECT_FALSE(fit_residual_law(std::vector{brief}, {}).holds());
}

}  // namespace
}  // namespace capstan::residual_law
