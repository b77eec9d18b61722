#include <gtest/gtest.h>

#include "capstan/gap/evidence.h"

namespace capstan::gap {
namespace {

struct Known {
    CandidateCause none;
    CandidateCause drag;
    CandidateCause gain;

    Known() {
        none.effect = "none";
        drag.effect = "viscous_friction";
        gain.effect = "sensor_gain";
        gain.family = "sensor";
        for (CandidateCause* cause : {&drag, &gain}) cause->numbers = {{"size", "", OpenNumber::Kind::size}};
        for (CandidateCause* cause : {&none, &drag, &gain})
            cause->friction_std = cause->stiffness_std = cause->pretension_std = nominal_log_std;
    }
};

ScoredFit fitted(const Evidence& evidence, std::vector<const CandidateCause*> causes, double misfit,
                 std::vector<double> visibility) {
    ScoredFit fit;
    fit.fit.causes = std::move(causes);
    fit.misfit = misfit;
    fit.visibility = std::move(visibility);
    fit.evidence = evidence.of(fit);
    return fit;
}

std::vector<RankedEffect> ranked_by(const Evidence& evidence, const std::vector<CandidateCause>& causes,
                                    const std::vector<ScoredFit>& fits, double nominal_misfit) {
    return Evidence::rank(causes, evidence.weigh(fits, nominal_misfit));
}

double probability(const std::vector<RankedEffect>& ranked, const std::string& effect) {
    for (const RankedEffect& each : ranked) {
        if (each.effect == effect) return each.probability;
    }
    return 0.0;
}

const Evidence evidence(200.0);

TEST(Evidence, FavoursNoneWhereNothingIsLeftToExplain) {
    const Known known;
    const auto ranked = ranked_by(
        evidence, {known.none, known.drag, known.gain},
        {fitted(evidence, {&known.none}, 0.9, {0.0}), fitted(evidence, {&known.drag}, 0.88, {0.3})}, 0.95);
    EXPECT_EQ(ranked.front().effect, "none");
    EXPECT_GT(ranked.front().probability, 0.9);
}

TEST(Evidence, FavoursTheCauseThatLeavesOnlyNoise) {
    const Known known;
    const auto ranked =
        ranked_by(evidence, {known.none, known.drag, known.gain},
                  {fitted(evidence, {&known.none}, 5.0, {0.0}), fitted(evidence, {&known.drag}, 1.0, {4.0}),
                   fitted(evidence, {&known.gain}, 3.0, {3.0})},
                  6.0);
    EXPECT_EQ(ranked.front().effect, "viscous_friction");
    EXPECT_EQ(ranked[1].effect, "unknown");
}

TEST(Evidence, UnusualNumbersLowerTheEvidenceByTheirPenalty) {
    const Known known;
    const ScoredFit usual = fitted(evidence, {&known.drag}, 1.0, {4.0});
    ScoredFit odd;
    odd.fit.causes = {&known.drag};
    odd.misfit = 1.0;
    odd.visibility = {4.0};
    odd.shape_penalty = 10.0;  // a number e^4.5 times what is usual
    EXPECT_NEAR(usual.evidence - evidence.of(odd), odd.shape_penalty, 1e-12);
}

TEST(Evidence, UnexplainedStructureIsReportedAsUnknown) {
    const Known known;
    const auto ranked = ranked_by(
        evidence, {known.none, known.drag},
        {fitted(evidence, {&known.none}, 9.0, {0.0}), fitted(evidence, {&known.drag}, 7.0, {3.0})}, 10.0);
    EXPECT_EQ(ranked.front().effect, "unknown");
}

TEST(Evidence, APairLeadsOnlyIfBothCausesAreVisible) {
    const Known known;
    const ScoredFit single = fitted(evidence, {&known.drag}, 2.0, {6.0});
    const ScoredFit both = fitted(evidence, {&known.drag, &known.gain}, 1.0, {6.0, 4.0});
    const ScoredFit faint = fitted(evidence, {&known.drag, &known.gain}, 1.0, {6.0, 0.2});
    EXPECT_GT(both.evidence, single.evidence);
    EXPECT_LT(faint.evidence, both.evidence - 40.0);
    const auto ranked = ranked_by(evidence, {known.none, known.drag, known.gain}, {single, both}, 40.0);
    EXPECT_NEAR(probability(ranked, "viscous_friction"), probability(ranked, "sensor_gain"), 0.01);
}

TEST(Evidence, ProbabilitiesSumToOneAndNoneIsZero) {
    const Known known;
    const auto ranked = ranked_by(
        evidence, {known.none, known.drag, known.gain},
        {fitted(evidence, {&known.none}, 50.0, {0.0}), fitted(evidence, {&known.drag}, 0.9, {9.0})}, 60.0);
    double sum = 0.0;
    for (const RankedEffect& each : ranked) {
        EXPECT_GT(each.probability, 0.0);
        sum += each.probability;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
}

}  // namespace
}  // namespace capstan::gap
