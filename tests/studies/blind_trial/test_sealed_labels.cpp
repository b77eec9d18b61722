#include <gtest/gtest.h>

#include "capstan/blind_trial/sealed_labels.h"
#include "capstan/blind_trial/trial_answer.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/platform/files.h"
#include "scratch_folder.h"

namespace capstan::gap_trial {
namespace {

TrialLabels sample_labels() {
    CaseLabel label;
    label.name = "case001";
    label.group = TruthGroup::catalogue;
    label.severity = Severity::mild;
    label.bench = "one_bend";
    label.protocols = {"tunnel", "sines"};
    label.causes = {{"local_bend",
                     "local_bend",
                     "conduit",
                     "",
                     Stretch{0.4, 0.5},
                     "angle_rad",
                     0.7,
                     {{"cables_0_both_1_a_2_b", 1.0}},
                     2.5,
                     "motor_angle"}};
    CaseLabel none;
    none.name = "case002";
    none.bench = "single_cable";
    none.protocols = {"single_sine"};
    TrialOptions options;
    options.cases = 2;
    options.nominal_error = 0.01;
    return {options, random_salt(), {label, none}};
}

// FIPS 180-4, its own example.
TEST(Sha256, OfAbc) {
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(SealedLabels, AreReadAsTheyWereWritten) {
    const ScratchFolder folder;
    const TrialLabels labels = sample_labels();
    const std::string seal = seal_labels(folder.path(), labels);
    const TrialLabels back = unseal_labels(folder.path() / "labels.json", seal);
    EXPECT_EQ(labels_text(back), labels_text(labels));
    EXPECT_EQ(back.cases.front().causes.front().where->to_m, 0.5);
    EXPECT_EQ(sha256(bytes_of(folder.path() / "labels.json")), seal);
    EXPECT_EQ(bytes_of(folder.path() / "labels.sha256"), seal + "  labels.json\n");
}

TEST(SealedLabels, TellWhatKindAllCasesAre) {
    TrialLabels labels = sample_labels();
    EXPECT_FALSE(read_labels(labels_text(labels), "labels.json").options.only);
    labels.options.only = TruthGroup::catalogue;
    EXPECT_EQ(read_labels(labels_text(labels), "labels.json").options.only, TruthGroup::catalogue);
}

TEST(SealedLabels, KeepTheNuisancesAndConditionsOfARig) {
    TrialLabels labels = sample_labels();
    labels.options.kind = TrialKind::rigs;
    labels.options.visibility = VisibilityRange{0.5, 10.0};
    CaseLabel& rig = labels.cases.front();
    rig.group = TruthGroup::three;
    rig.severity.reset();
    rig.causes.front().varies = "roll_deg";
    rig.nuisances = {{"sensor_offset", "load_torque", -0.25}, {"param_mu", "", 0.125}};
    rig.conditions = {"roll_deg"};
    const TrialLabels back = read_labels(labels_text(labels), "labels.json");
    EXPECT_EQ(labels_text(back), labels_text(labels));
    EXPECT_EQ(back.options.kind, TrialKind::rigs);
    EXPECT_EQ(back.options.visibility->high, 10.0);
    EXPECT_EQ(back.cases.front().causes.front().varies, "roll_deg");
    EXPECT_EQ(back.cases.front().nuisances.front().size, -0.25);
    EXPECT_EQ(back.cases.front().conditions, std::vector<std::string>{"roll_deg"});
}

TEST(SealedLabels, AreNotScoredWithoutTheirSeal) {
    const ScratchFolder folder;
    seal_labels(folder.path(), sample_labels());
    const std::filesystem::path file = folder.path() / "labels.json";
    write_file(folder.path() / "labels.sha256", "");
    EXPECT_THROW(unseal_labels(file, ""), InvalidInput);
    std::filesystem::remove(folder.path() / "labels.sha256");
    try {
        unseal_labels(file, "");
        FAIL() << "labels without a seal were scored";
    } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("gap-trial --keep"), std::string::npos) << error.what();
    }
}

TEST(SealedLabels, AChangeIsDetected) {
    const ScratchFolder folder;
    const std::string seal = seal_labels(folder.path(), sample_labels());
    const std::filesystem::path file = folder.path() / "labels.json";
    std::string text = bytes_of(file);
    text.replace(text.find("local_bend"), 10, "param_mu  ");
    write_file(file, text);
    EXPECT_THROW(unseal_labels(file), InvalidInput);
    // Even with a hash of the new text beside it, what was printed before tells.
    write_file(folder.path() / "labels.sha256", sha256(text) + "  labels.json\n");
    EXPECT_THROW(unseal_labels(file, seal), InvalidInput);
}

TEST(SealedLabels, TheSaltChangesTheHash) {
    TrialLabels once = sample_labels();
    TrialLabels again = once;
    again.salt = random_salt();
    EXPECT_NE(sha256(labels_text(once)), sha256(labels_text(again)));
}

TEST(SealedLabels, OtherFilesAreRefusedWithAReason) {
    try {
        read_labels(R"({"salt": "0", "cases": 3})", "my.json");
        FAIL() << "accepted a file that is not a label";
    } catch (const InvalidInput& problem) {
        EXPECT_NE(std::string(problem.what()).find("my.json"), std::string::npos);
    }
}

TEST(CaseAnswer, IsReadAsItWasWrittenUnderItsSeal) {
    const ScratchFolder folder;
    const std::filesystem::path file = folder.path() / "case001.json";
    const CaseAnswer answer{"case001", {{"creep", 0.75}, {"none", 0.25}}, {"creep"}, "cable", "",
                            1.25,      {{"load_torque", 0.5, 0.25}}};
    write_answer(file, answer, "abc");
    const CaseAnswer back = read_answer(file, "abc");
    EXPECT_EQ(back.ranked.front().effect, "creep");
    EXPECT_EQ(back.ranked.back().probability, 0.25);
    EXPECT_EQ(back.position_m, 1.25);
    EXPECT_FALSE(back.ranked.front().present);
    EXPECT_EQ(back.channels.front().after, 0.25);
    EXPECT_FALSE(back.channels.front().held_out);
    EXPECT_EQ(back.named, std::vector<std::string>{"creep"});
    EXPECT_THROW(read_answer(file, "another"), InvalidInput);
}

TEST(CaseAnswer, KeepsWhatIsPresentAndWhatItFollows) {
    const ScratchFolder folder;
    CaseAnswer answer;
    answer.name = "case001";
    answer.ranked = {{"param_mu", 0.5, 0.99, "roll_deg"}, {"creep", 0.5, 0.75}};
    answer.channels = {{"load_torque", 0.5, 0.25, 0.3125}};
    write_answer(folder.path() / "case001.json", answer, "abc");
    const CaseAnswer back = read_answer(folder.path() / "case001.json", "abc");
    EXPECT_EQ(back.ranked.front().present, 0.99);
    EXPECT_EQ(back.ranked.front().varies, "roll_deg");
    EXPECT_EQ(back.ranked.back().varies, "");
    EXPECT_EQ(back.channels.front().held_out, 0.3125);
}

}  // namespace
}  // namespace capstan::gap_trial
