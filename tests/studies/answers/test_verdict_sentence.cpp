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
    diagnosis.candidates = {{.effects = causes}};
    return diagnosis;
}

TEST(VerdictSentence, SaysThatNothingIsVisibleBesideNumbersOfTheBench) {
    gap::Diagnosis numbers = verdict({{"param_K", 0.4, 0.98}, {"param_T0", 0.4, 0.98}, {"none", 0.15, 0.48}},
                                     {"param_K", "param_T0"});
    numbers.candidates.front().is_only_the_bench = true;
    EXPECT_EQ(
        verdict_sentence(numbers),
        "The bench's own numbers explain the gap: wrong cable stiffness, wrong pretension. Nothing else "
        "is visible; a cause that is too faint to show may act beside them.");
}

TEST(VerdictSentence, SaysThatACauseTooFaintToShowMayAct) {
    gap::Diagnosis nothing = verdict({{"none", 0.93, 0.95}}, {});
    EXPECT_EQ(verdict_sentence(nothing),
              "There is no gap beyond noise and the floor of the model (probability 0.93).");
    nothing.bench = {{"zero of load_torque", "N m", 0.01, {}, false}};
    EXPECT_EQ(
        verdict_sentence(nothing),
        "There is no gap beyond noise and the floor of the model (probability 0.93; a cause that is too "
        "faint to show beside the bench's own numbers may act).");
}

TEST(VerdictSentence, NamesTheMostProbableCauseOfSeveralExplanations) {
    gap::Diagnosis shared = verdict({{"stribeck", 0.4, 0.6}, {"none", 0.3, 0.3}}, {});
    shared.candidates = {{.effects = {"none"}}};
    EXPECT_EQ(
        verdict_sentence(shared),
        "The most probable cause is Stribeck friction (probability 0.60). The numbers below are those of "
        "the bench without a cause.");
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
