#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "capstan/config/config_file.h"
#include "capstan/config/config_problem.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/config_truth.h"
#include "capstan/config/config_writer.h"

namespace capstan::config {
namespace {

using testing::HasSubstr;

class TruthFile : public testing::Test {
  protected:
    ~TruthFile() override {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }

    TrueCable read(const std::string& text) const {
        std::ofstream(path_) << text;
        return read_truth(path_);
    }

    const std::filesystem::path path_ =
        std::filesystem::temp_directory_path() /
        (std::string("capstan_") + testing::UnitTest::GetInstance()->current_test_info()->name() + "_" +
         std::to_string(getpid()) + ".toml");
};

TEST_F(TruthFile, ReadsBackToTheSameBits) {
    TrueCable truth;
    truth.friction_ratio = 1.0 / 3.0;
    truth.stiffness_ratio = 2.0;
    for (std::size_t e = 0; e < truth.effects.size(); ++e) {
        if (!effect_catalogue()[e].changes_the_cable) continue;
        for (std::size_t p = 0; p < truth.effects[e].size(); ++p)
            truth.effects[e][p] = effect_catalogue()[e].parameters[p].typical * 1.1;
    }
    const TrueCable back = read(truth_text(truth, {"a comment", "another"}));
    EXPECT_EQ(back.friction_ratio, truth.friction_ratio);
    EXPECT_EQ(back.stiffness_ratio, truth.stiffness_ratio);
    EXPECT_EQ(back.pretension_ratio, 1.0);
    EXPECT_EQ(back.effects, truth.effects);
}

TEST_F(TruthFile, OfNothingIsTheModel) {
    const TrueCable truth = read(truth_text({}, {}));
    EXPECT_EQ(truth.friction_ratio, 1.0);
    EXPECT_EQ(truth.stiffness_ratio, 1.0);
    EXPECT_EQ(truth.pretension_ratio, 1.0);
    EXPECT_FALSE(truth.has_effects());
}

TEST_F(TruthFile, RejectsOtherContentWithItsLine) {
    try {
        read("[truth]\nfriction_ratio = 1.1\n[recommendation]\nworthwhile_gain_N = 0.1\n");
        FAIL() << "was taken";
    } catch (const ConfigError& error) {
        EXPECT_THAT(error.what(), HasSubstr(":4: recommendation.worthwhile_gain_N: does not belong"));
    }
}

TEST_F(TruthFile, RefusesEffectsOfPulleys) {
    EXPECT_THROW(read("[truth.pulley_friction_motor]\ncoulomb_Nm = 0.01\n"), ConfigError);
}

// What a stored study needs to go on without the diagnosis.
TEST(TruthOfWorlds, KeepsItsSpreadInTheConfigurationAndChecksItsShape) {
    StudyPlan plan = parse_config("[uncertainty]\n", "arm").plan;
    plan.truth.friction_fraction = 0.04;
    std::size_t e = 0;
    while (effect_catalogue()[e].name != "viscous_friction") ++e;
    plan.truth.effect_deviations[e] = {0.25};
    const std::string text = config_text(plan, Comments::none);
    const TrueCable back = parse_config(text, "stored").plan.truth;
    EXPECT_EQ(back.friction_fraction, 0.04);
    EXPECT_EQ(back.effect_deviations, plan.truth.effect_deviations);
    plan.truth.effect_deviations[e] = {0.25, 0.5};
    EXPECT_THROW(parse_config(config_text(plan, Comments::none), "stored"), ConfigError);
    EXPECT_THROW(parse_config("[truth]\nfriction_fraction = 0.04\n", "instants"), ConfigError);
}

}  // namespace
}  // namespace capstan::config
