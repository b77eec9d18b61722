#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "capstan/answers/recording_answers.h"
#include "capstan/gap/diagnosis.h"

namespace capstan::answers {
namespace {

gap::Diagnosis verdict(const std::vector<gap::RankedEffect>& ranked, const std::vector<std::string>& causes) {
    gap::Diagnosis diagnosis;
    diagnosis.ranked = ranked;
    for (const std::string& cause : causes) diagnosis.causes.push_back({cause, "", "", "", {}, {}});
    return diagnosis;
}

TEST(VerdictSentence, SaysThatNothingActsBesideNumbersOfTheBench) {
    const std::string text = verdict_sentence(verdict(
        {{"param_K", 0.4, 0.98}, {"param_T0", 0.4, 0.98}, {"none", 0.15, 0.95}}, {"param_K", "param_T0"}));
    EXPECT_EQ(
        text,
        "The bench's own numbers explain the gap: wrong cable stiffness, wrong pretension. Nothing acts "
        "beside them (probability 0.95).");
}

TEST(VerdictSentence, NamesACauseBesideWhichNoneIsImprobable) {
    const std::string text = verdict_sentence(
        verdict({{"viscous_friction", 0.9, 0.96}, {"none", 0.02, 0.03}}, {"viscous_friction"}));
    EXPECT_EQ(text, "The cause is viscous friction (probability 0.96).");
}

TEST(VerdictSentence, CountsCausesThatActTogether) {
    const std::string text = verdict_sentence(verdict(
        {{"creep", 0.49, 0.98}, {"backlash", 0.49, 0.98}, {"none", 0.01, 0.0}}, {"creep", "backlash"}));
    EXPECT_EQ(text, "2 causes act together: cable creep and backlash.");
}

TEST(VerdictSentence, SaysWhatNoKnownEffectExplains) {
    const std::string text = verdict_sentence(
        verdict({{"unknown", 0.6, 0.9}, {"creep", 0.38, 0.98}, {"none", 0.01, 0.0}}, {"creep"}));
    EXPECT_EQ(text,
              "There is a gap that no known effect explains completely (probability 0.90). A part of it is "
              "probably cable creep (0.98). The numbers below are those of the best known effect.");
}

}  // namespace
}  // namespace capstan::answers
