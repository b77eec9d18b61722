#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "capstan/effects/effect_catalogue.h"

namespace capstan {
namespace {

double by_differences(const std::function<double(double)>& f, double at, double step) {
    return (f(at + step) - f(at - step)) / (2.0 * step);
}

TEST(Bristles, BendTowardsFullFrictionAndNeverBeyond) {
    for (const double exponent : {0.0, 0.5, 1.0, 1.5}) {
        const Presliding law{1e-4, exponent};
        double bend = -1.0;
        for (int step = 0; step < 200; ++step) {
            const double next = law.after(bend, 5e-6).bend;
            EXPECT_GE(next, bend) << exponent;
            EXPECT_LE(next, 1.0) << exponent;
            bend = next;
        }
        EXPECT_GT(bend, 0.95) << exponent;
    }
}

TEST(Bristles, OneStepOrManyBendTheSame) {
    for (const double exponent : {0.0, 0.5, 1.0, 1.5}) {
        const Presliding law{1e-4, exponent};
        double many = -0.7;
        for (int step = 0; step < 50; ++step) many = law.after(many, 2e-6).bend;
        EXPECT_NEAR(law.after(-0.7, 1e-4).bend, many, 1e-12) << exponent;
    }
}

TEST(Bristles, SlopeIsTheDerivative) {
    for (const double exponent : {0.0, 0.5, 1.0, 1.5}) {
        const Presliding law{1e-4, exponent};
        for (const double slid_m : {-8e-5, -1e-5, 2e-5, 6e-5}) {
            const double slope =
                by_differences([&](double u) { return law.after(0.1, u).bend; }, slid_m, 1e-9);
            EXPECT_NEAR(law.after(0.1, slid_m).bend_per_m, slope, 1e-4 / 1e-4) << exponent << " " << slid_m;
        }
    }
}

TEST(NonlinearStiffness, ComplianceIsTheStrainsDerivative) {
    const NonlinearStiffness toe{2e-3, 8.0};
    for (const double tension_N : {0.1, 3.0, 20.0}) {
        const double slope = by_differences([&](double t) { return toe.strain(t, 4000.0); }, tension_N, 1e-4);
        EXPECT_NEAR(toe.strain_per_N(tension_N, 4000.0), slope, 1e-10);
    }
    EXPECT_GT(toe.strain_per_N(1.0, 4000.0), toe.strain_per_N(30.0, 4000.0));
}

TEST(Cogging, SlopeIsTheDerivative) {
    const MotorCogging cogging{0.3, -0.2, 11.0};
    for (const double angle_rad : {-1.0, 0.05, 2.0}) {
        EXPECT_NEAR(cogging.slope_Nm_per_rad(angle_rad),
                    by_differences([&](double a) { return cogging.torque_Nm(a); }, angle_rad, 1e-6), 1e-7);
    }
}

TEST(Stribeck, FrictionFallsWithSpeedToCoulombs) {
    const Stribeck law{0.1, 0.05, 0.0};
    EXPECT_EQ(law.friction_added(0.0), 0.1);
    EXPECT_GT(law.friction_added(0.02), law.friction_added(0.04));
    EXPECT_NEAR(law.friction_added(1.0), 0.0, 1e-12);
}

TEST(Catalogue, NamesEachVariantOnceWithParametersInTheirLimits) {
    std::set<std::pair<std::string, std::string>> seen;
    for (const Effect& effect : effect_catalogue()) {
        EXPECT_TRUE(seen.insert({effect.name, effect.variant}).second)
            << effect.name << " " << effect.variant;
        EXPECT_FALSE(effect.meaning.empty());
        EXPECT_EQ(effect.equation.substr(0, 1), "E");
        ASSERT_EQ(effect.absent.size(), effect.parameters.size()) << effect.name;
        for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
            const EffectParameter& parameter = effect.parameters[k];
            EXPECT_GE(parameter.typical, parameter.low) << effect.name << " " << parameter.name;
            EXPECT_LE(parameter.typical, parameter.high) << effect.name << " " << parameter.name;
            EXPECT_GE(effect.absent[k], parameter.low) << effect.name << " " << parameter.name;
        }
    }
}

TEST(Catalogue, WithEveryEffectAbsentNoneIsThere) {
    EXPECT_TRUE(effects_there(absent_effects()).empty());
    EXPECT_EQ(effects_with(absent_effects()).creep.ratio, BenchEffects{}.creep.ratio);
}

TEST(Catalogue, AnEffectIsThereUnderItsOwnNameAndAlone) {
    for (std::size_t k = 0; k < effect_catalogue().size(); ++k) {
        const Effect& effect = effect_catalogue()[k];
        EffectValues values = absent_effects();
        for (std::size_t p = 0; p < effect.parameters.size(); ++p) values[k][p] = effect.parameters[p].typical;
        const std::vector<std::string> there = effects_there(values);
        ASSERT_EQ(there.size(), 1u) << effect.name;
        EXPECT_EQ(there[0].substr(0, effect.name.size()), effect.name);
        EXPECT_NE(there[0].find(effect.variant), std::string::npos);
    }
}

TEST(Catalogue, ValuesReachTheBench) {
    EffectValues values = absent_effects();
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (effect_catalogue()[k].name == "creep") values[k] = {0.3, 5.0};
    }
    const BenchEffects effects = effects_with(values);
    EXPECT_EQ(effects.creep.ratio, 0.3);
    EXPECT_EQ(effects.creep.time_constant_s, 5.0);
    EXPECT_EQ(effects.load_backlash.half_gap_rad, 0.0);
}

}  // namespace
}  // namespace capstan
