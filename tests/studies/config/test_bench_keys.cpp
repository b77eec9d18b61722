#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "capstan/config/config_key.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/config_writer.h"
#include "capstan/effects/effect_catalogue.h"
#include "problems_in.h"

namespace capstan::config {
namespace {

using bench::BenchPlan;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

BenchPlan plan_of(const std::string& toml) {
    return parse_plan<BenchPlan>("kind = \"bench\"\n" + toml, "x.toml").plan;
}

// The text begins on line 2.
std::vector<std::string> bench_problems_in(const std::string& toml) {
    return problems_of_reading([&] { plan_of(toml); });
}

TEST(BenchKeys, TheDefaultIsThePapersRampsWithoutEffects) {
    const BenchPlan plan = plan_of("");
    EXPECT_EQ(plan.motor_drive, bench::MotorDrive::torque);
    EXPECT_DOUBLE_EQ(plan.motor.at(1.0), 0.1);
    EXPECT_EQ(plan.load_kind, bench::LoadKind::locked);
    EXPECT_THAT(effects_there(plan.effects), IsEmpty());
}

TEST(BenchKeys, PrintedDefaultReadsBackAsTheDefault) {
    const std::string text = config_text(default_bench(), Comments::every_key);
    EXPECT_EQ(config_text(parse_plan<BenchPlan>(text, "default").plan, Comments::none),
              config_text(default_bench(), Comments::none));
}

TEST(BenchKeys, UnknownKeysAreNamedWithLineAndNearestName) {
    EXPECT_THAT(bench_problems_in("[motor]\namplitdue_Nm = 1\n"),
                ElementsAre("3: motor.amplitdue_Nm: unknown key; did you mean 'amplitude_Nm'?"));
    EXPECT_THAT(bench_problems_in("[effect.viscuos_friction]\n"),
                ElementsAre(HasSubstr("did you mean 'viscous_friction'?")));
}

TEST(BenchKeys, AnInputsValuesMustBeInItsUnitAndOfItsWaveform) {
    EXPECT_THAT(
        bench_problems_in("[motor]\ninput = \"angle\"\namplitude_Nm = 0.1\n"),
        ElementsAre(HasSubstr("has a meaning only with waveform = \"ramps\" and input = \"torque\"")));
    EXPECT_THAT(bench_problems_in("[motor]\nwaveform = \"steps\"\ndwell_s = 1\n"),
                ElementsAre(HasSubstr("has a meaning only with waveform = \"ramps\"")));
    EXPECT_THAT(bench_problems_in("[load]\nwaveform = \"sines\"\n"),
                ElementsAre(HasSubstr("has a meaning only with input")));
    EXPECT_THAT(bench_problems_in("[load]\ninput = \"spring\"\n"),
                ElementsAre(HasSubstr("stiffness_Nm_per_rad: is missing")));
}

TEST(BenchKeys, TorqueAtBothPulleysIsRefused) {
    EXPECT_THAT(bench_problems_in("[load]\ninput = \"torque\"\n"),
                ElementsAre(StartsWith("3: load.input: is \"torque\"")));
}

TEST(BenchKeys, EachSineNeedsItsFrequencyAndPhase) {
    EXPECT_THAT(
        bench_problems_in("[motor]\nwaveform = \"sines\"\namplitudes_Nm = [0.1, 0.1]\nphases_rad = [0, 0]\n"),
        ElementsAre(HasSubstr("has 1 numbers for 2 amplitudes")));
    EXPECT_THAT(plan_of("[motor]\nwaveform = \"sines\"\namplitudes_Nm = [0.1, 0.1]\nfrequencies_Hz = [1, 2]\n"
                        "phases_rad = [0, 0]\n")
                    .motor.amplitudes,
                ElementsAre(0.1, 0.1))
        << "the same number twice is right here";
}

TEST(BenchKeys, EveryEffectOfTheCatalogueHasItsKeys) {
    std::size_t parameters = 0;
    for (const Effect& effect : effect_catalogue()) parameters += effect.parameters.size();
    std::size_t keys = 0;
    for (const auto& key : config_schema<BenchPlan>().keys) keys += key.section.starts_with("effect.");
    EXPECT_EQ(keys, parameters);
    const BenchPlan plan = plan_of("[effect.local_bend_cable_A]\nangle_rad = 0.5\n");
    EXPECT_THAT(effects_there(plan.effects), ElementsAre("local_bend (cable A)"));
    EXPECT_THAT(bench_problems_in("[effect.backlash_motor]\nhalf_gap_rad = 2\n"),
                ElementsAre(HasSubstr("is 2 rad, but must be at most 1")));
}

TEST(BenchKeys, FrictionAtRestIsAtLeastThatOfSliding) {
    EXPECT_THAT(bench_problems_in("[cable]\ndynamic_friction = 0.7\nstatic_friction = 0.6\n"),
                ElementsAre(HasSubstr("below dynamic_friction")));
}

TEST(BenchKeys, StaticFrictionFollowsAStatedDynamicFriction) {
    EXPECT_EQ(plan_of("[cable]\ndynamic_friction = 0.7\n").cable.static_friction, 0.7);
    EXPECT_EQ(plan_of("").cable.static_friction, 0.63);
}

}  // namespace
}  // namespace capstan::config
