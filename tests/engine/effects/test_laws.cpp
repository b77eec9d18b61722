#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "capstan/effects/effect_catalogue.h"

namespace capstan {
namespace {

double by_differences(const std::function<double(double)>& f, double at, double step) {
    return (f(at + step) - f(at - step)) / (2.0 * step);
}

TEST(Bristles, BendTowardsFullFrictionAndNotBeyond) {
    for (const double exponent : {0.0, 0.5, 1.0, 1.5}) {
        const Presliding law{1e-4, exponent};
        double bend = -1.0;
        for (int step = 0; step < 200; ++step) {
            const double next = laws::bristle_after(law, bend, 5e-6).bend;
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
        for (int step = 0; step < 50; ++step) many = laws::bristle_after(law, many, 2e-6).bend;
        EXPECT_NEAR(laws::bristle_after(law, -0.7, 1e-4).bend, many, 1e-12) << exponent;
    }
}

TEST(Bristles, SlopeIsTheDerivative) {
    for (const double exponent : {0.0, 0.5, 1.0, 1.5}) {
        const Presliding law{1e-4, exponent};
        for (const double slid_m : {-8e-5, -1e-5, 2e-5, 6e-5}) {
            const double slope =
                by_differences([&](double u) { return laws::bristle_after(law, 0.1, u).bend; }, slid_m, 1e-9);
            EXPECT_NEAR(laws::bristle_after(law, 0.1, slid_m).bend_per_m, slope, 1e-4 / 1e-4)
                << exponent << " " << slid_m;
        }
    }
}

TEST(NonlinearStiffness, SlopeIsTheDerivative) {
    const NonlinearStiffness toe{2e-3, 8.0};
    for (const double ratio : {0.01, 0.4, 2.5}) {
        const double slope =
            by_differences([&](double t) { return laws::toe_strain(toe, t).strain; }, ratio, 1e-5);
        EXPECT_NEAR(laws::toe_strain(toe, ratio).slope, slope, 1e-10);
    }
    EXPECT_GT(laws::toe_strain(toe, 0.1).slope, laws::toe_strain(toe, 4.0).slope);
}

TEST(Cogging, SlopeIsTheDerivative) {
    for (const MotorCogging& cogging :
         {MotorCogging{0.3, -0.2, 11.0}, MotorCogging{0.3, -0.2, 11.0, 0.1, -0.15}}) {
        for (const double angle_rad : {-1.0, 0.05, 2.0}) {
            EXPECT_NEAR(cogging.torque(angle_rad).per_rad,
                        by_differences([&](double a) { return cogging.torque(a).value_Nm; }, angle_rad, 1e-6),
                        1e-7);
        }
    }
}

TEST(Cogging, ItsSecondHarmonicIsARippleOfTwiceThePeriods) {
    const MotorCogging second{0.0, 0.0, 5.0, 0.1, -0.15};
    const MotorCogging twice{0.1, -0.15, 10.0};
    for (const double angle_rad : {-1.0, 0.05, 2.0})
        EXPECT_NEAR(second.torque(angle_rad).value_Nm, twice.torque(angle_rad).value_Nm, 1e-12);
}

TEST(PositionTorque, SlopeIsTheDerivative) {
    const PositionTorque spring{0.3, -0.2};
    for (const double angle_rad : {-1.0, 0.05, 2.0}) {
        EXPECT_NEAR(spring.torque(angle_rad).per_rad,
                    by_differences([&](double a) { return spring.torque(a).value_Nm; }, angle_rad, 1e-6),
                    1e-7);
    }
}

TEST(EccentricPulley, ReelsInWhatItsRadiusSweeps) {
    const EccentricPulley pulley{0.2, -0.1, 0.05};
    EXPECT_EQ(pulley.radius_ratio(0.0), 1.05);
    EXPECT_EQ(pulley.reeled_rad(0.0), 0.0);
    for (const double angle_rad : {-1.0, 0.05, 2.0}) {
        EXPECT_NEAR(pulley.radius_ratio(angle_rad),
                    by_differences([&](double a) { return pulley.reeled_rad(a); }, angle_rad, 1e-6), 1e-7);
        EXPECT_NEAR(pulley.radius_ratio_per_rad(angle_rad),
                    by_differences([&](double a) { return pulley.radius_ratio(a); }, angle_rad, 1e-6), 1e-7);
    }
}

TEST(Stribeck, FrictionFallsWithSpeedToCoulombs) {
    const Stribeck law{0.1, 0.05, 0.0};
    EXPECT_EQ(laws::added_friction(law, 0.0), 0.1);
    EXPECT_GT(laws::added_friction(law, 0.02), laws::added_friction(law, 0.04));
    EXPECT_NEAR(laws::added_friction(law, 1.0), 0.0, 1e-12);
}

TEST(Stribeck, TheLaggingSpeedApproachesASteadySpeed) {
    const Stribeck law{.extra_friction = 0.1, .memory_s = 0.04};
    double lagging = 0.0;
    for (int step = 0; step < 400; ++step) lagging = laws::lagging_speed(law, lagging, 0.3, 1e-3);
    EXPECT_NEAR(lagging, 0.3, 0.3 * std::exp(-8.0));
    EXPECT_EQ(laws::lagging_speed(Stribeck{.memory_s = 0.0}, 0.1, 0.3, 1e-3), 0.3);
}

TEST(ViscousFriction, DragIsProportionalToSpeedAndLength) {
    const ViscousFriction law{3.0};
    const double slid_m = 2e-3;
    EXPECT_DOUBLE_EQ(laws::sliding_drag_N_per_m(law, 0.5, 0.01) * slid_m, 3.0 * 0.5 * slid_m / 0.01);
}

TEST(LoadDependentFriction, IsAPowerLawOfTheNormalForceWithinItsLimits) {
    const LoadDependentFriction law{.exponent = 0.8, .reference_N_per_m = 10.0};
    EXPECT_EQ(laws::friction_factor(law, 10.0), 1.0);
    EXPECT_DOUBLE_EQ(laws::friction_factor(law, 20.0), std::pow(2.0, -0.2));
    EXPECT_EQ(laws::friction_factor(law, 0.0), laws::friction_factor(law, 0.5));
    EXPECT_EQ(laws::friction_factor(law, 1e6), laws::friction_factor(law, 200.0));
}

TEST(BendingStiffness, DragDoesNotDependOnTension) {
    EXPECT_DOUBLE_EQ(laws::constant_drag_N(BendingStiffness{0.2}, 0.5), 0.1);
}

TEST(Creep, ApproachesItsFractionOfTheElasticStrain) {
    const Creep law{.ratio = 0.2, .time_constant_s = 2.0};
    double strain = 0.0;
    for (int step = 0; step < 2000; ++step)
        strain += laws::creep_fraction(law, 0.01) * (laws::creep_at_rest(law, 1e-3) - strain);
    EXPECT_NEAR(strain, 2e-4, 2e-4 * 1e-4);
    EXPECT_EQ(laws::creep_fraction(Creep{}, 0.01), 0.0);
}

TEST(Backlash, TransmitsNothingWithinTheGap) {
    EXPECT_EQ(Backlash::beyond_gap_rad(0.009, 0.01), 0.0);
    EXPECT_DOUBLE_EQ(Backlash::beyond_gap_rad(0.03, 0.01), 0.02);
    EXPECT_DOUBLE_EQ(Backlash::beyond_gap_rad(-0.03, 0.01), -0.02);
}

TEST(BearingFriction, FollowsTheSignOfTheSpeed) {
    const BearingFriction law{.coulomb_Nm = 0.2, .viscous_Nm_s = 0.1};
    for (const double speed : {-2.0, 2.0}) {
        const Torque torque = law.torque(BearingFriction::sign_of(speed, 0.01), speed, 1.0 / 0.01);
        EXPECT_NEAR(torque.value_Nm, std::copysign(0.2, speed) + 0.1 * speed, 1e-12);
    }
}

TEST(Catalogue, NamesEachVariantOnceWithParametersInTheirLimits) {
    std::set<std::pair<std::string, std::string>> seen;
    for (const Effect& effect : effect_catalogue()) {
        EXPECT_TRUE(seen.insert({effect.name, effect.variant}).second)
            << effect.name << " " << effect.variant;
        EXPECT_FALSE(effect.meaning.empty());
        EXPECT_FALSE(effect.title.empty());
        EXPECT_FALSE(effect.family.empty());
        EXPECT_FALSE(effect.component.empty());
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

TEST(Catalogue, StandsInTheTableOfEquations) {
    std::ostringstream text;
    text << std::ifstream(ENGINE_README).rdbuf();
    for (const Effect& effect : effect_catalogue())
        EXPECT_NE(text.str().find("| " + effect.equation + " | " + effect.title), std::string::npos)
            << "engine/README.md lacks the row of " << effect.title;
}

TEST(Catalogue, WithEveryEffectAbsentNoneIsThere) {
    EXPECT_TRUE(effects_there(absent_effects()).empty());
    EXPECT_EQ(effects_with(absent_effects()).of<Creep>().ratio, BenchEffects{}.of<Creep>().ratio);
}

TEST(Catalogue, AnEffectIsThereUnderItsOwnNameAndAlone) {
    for (std::size_t k = 0; k < effect_catalogue().size(); ++k) {
        const Effect& effect = effect_catalogue()[k];
        EffectValues values = absent_effects();
        for (std::size_t p = 0; p < effect.parameters.size(); ++p)
            values[k][p] = effect.parameters[p].typical;
        const std::vector<std::string> there = effects_there(values);
        ASSERT_EQ(there.size(), 1u) << effect.name;
        EXPECT_EQ(there[0].substr(0, effect.name.size()), effect.name);
        EXPECT_NE(there[0].find(effect.variant), std::string::npos);
    }
}

TEST(Catalogue, ValuesAreReadBackFromTheBenchTheyWereAppliedTo) {
    for (const Effect& effect : effect_catalogue()) {
        BenchEffects effects;
        std::vector<double> values;
        for (const EffectParameter& parameter : effect.parameters) values.push_back(1.1 * parameter.typical);
        effect.apply(effects, values);
        EXPECT_EQ(effect.values_in(effects), values) << effect.name << " " << effect.variant;
    }
}

TEST(Catalogue, ABendOfOneCableIsNotReadAsABendOfTheOther) {
    BenchEffects effects;
    effects.of<LocalBend>().cables = BentCables::only_b;
    for (const Effect& effect : effect_catalogue()) {
        if (effect.name != "local_bend") continue;
        EXPECT_EQ(effect.values_in(effects).has_value(), effect.variant == "cable B") << effect.variant;
    }
}

TEST(Catalogue, ValuesReachTheBench) {
    EffectValues values = absent_effects();
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (effect_catalogue()[k].name == "creep") values[k] = {0.3, 5.0};
    }
    const BenchEffects effects = effects_with(values);
    EXPECT_EQ(effects.of<Creep>().ratio, 0.3);
    EXPECT_EQ(effects.of<Creep>().time_constant_s, 5.0);
    EXPECT_EQ(effects.of<Backlash>().load_half_gap_rad, 0.0);
}

TEST(PretensionDrift, LosesItsPartInTheFirstHundredSecondsHoweverItSettles) {
    for (const double settling_s : {10.0, 100.0, 1000.0, PretensionDrift::steady_s})
        EXPECT_NEAR((PretensionDrift{0.3, settling_s}.ratio(100.0)), 0.7, 1e-12) << settling_s;
}

TEST(PretensionDrift, IsSteadyUnlessItIsToldToSettle) {
    const PretensionDrift steady{0.2};
    EXPECT_DOUBLE_EQ(steady.ratio(0.0), 1.0);
    for (const double time_s : {10.0, 50.0, 200.0})
        EXPECT_NEAR(steady.ratio(time_s), 1.0 - 0.2 * time_s / 100.0, 0.005) << time_s;
}

TEST(PretensionDrift, FallsEverMoreSlowlyAsTheCableSettles) {
    const PretensionDrift drift{0.2, 50.0};
    const double early = drift.ratio(0.0) - drift.ratio(20.0);
    const double late = drift.ratio(60.0) - drift.ratio(80.0);
    EXPECT_NEAR(late / early, std::exp(-60.0 / 50.0), 1e-12);
    EXPECT_GT(drift.ratio(1e6), 0.7);
}

TEST(PretensionDrift, ALossOfAllPretensionLeavesNone) {
    EXPECT_DOUBLE_EQ((PretensionDrift{0.9, 1000.0}.ratio(500.0)), 0.0);
}

}  // namespace
}  // namespace capstan
