#include <gtest/gtest.h>

#include <cmath>

#include "capstan/gap/evidence.h"
#include "nearly_certain.h"

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

// Residuals in which no discrepancy finds anything: its freedom only costs.
Marginals only_noise(double misfit) {
    Marginals beside;
    for (std::size_t k = 0; k < beside.size(); ++k)
        beside[k] = {misfit, 20.0 * std::log1p(std::pow(discrepancy_sizes[k], 2))};
    return beside;
}

ScoredFit fitted(const Evidence& evidence, std::vector<const CandidateCause*> causes, double misfit,
                 std::vector<double> visibility) {
    ScoredFit fit;
    fit.fit.causes = std::move(causes);
    // The recording determines each size to about a fiftieth of what was probable.
    for (const CandidateCause* cause : fit.fit.causes)
        fit.fit.log_volume_ratio -= static_cast<double>(cause->numbers.size()) * std::log(50.0);
    fit.misfit = misfit;
    fit.beside = only_noise(misfit);
    fit.visibility = std::move(visibility);
    fit.evidence = evidence.of(fit);
    return fit;
}

std::vector<RankedEffect> ranked_by(const Evidence& evidence, const std::vector<CandidateCause>& causes,
                                    const std::vector<ScoredFit>& fits) {
    return Evidence::rank(causes, evidence.weigh(fits));
}

double probability(const std::vector<RankedEffect>& ranked, const std::string& effect) {
    for (const RankedEffect& each : ranked) {
        if (each.effect == effect) return each.probability;
    }
    return 0.0;
}

double present(const std::vector<RankedEffect>& ranked, const std::string& effect) {
    for (const RankedEffect& each : ranked) {
        if (each.effect == effect) return each.present;
    }
    return 0.0;
}

const Evidence evidence(200.0);

TEST(Evidence, FavoursNoneWhereNothingIsLeftToExplain) {
    const Known known;
    const auto ranked = ranked_by(
        evidence, {known.none, known.drag, known.gain},
        {fitted(evidence, {&known.none}, 0.9, {0.0}), fitted(evidence, {&known.drag}, 0.88, {0.3})});
    EXPECT_EQ(ranked.front().effect, "none");
    EXPECT_GT(ranked.front().probability, nearly_certain);
}

// The floor is an upper value, and a fit may follow the model's own error below it; where the scale of an
// error is not known (E54), nothing says that it is the model's.
TEST(Evidence, CountsWhatIsLeftBelowTheFloorOnlyWhereTheScaleOfAnErrorIsNotKnown) {
    const Known known;
    const auto gain_of_a_cause = [&](bool has_unknown_scales) {
        ScoredFit none = fitted(evidence, {&known.none}, 0.5, {0.0});
        ScoredFit drag = fitted(evidence, {&known.drag}, 0.25, {1.0});
        for (ScoredFit* each : {&none, &drag}) {
            each->has_unknown_scales = has_unknown_scales;
            each->evidence = evidence.of(*each);
        }
        return drag.evidence - none.evidence;
    };
    EXPECT_LT(gain_of_a_cause(false), 20.0);
    EXPECT_GT(gain_of_a_cause(true), 60.0);
    EXPECT_GT(gain_of_a_cause(true), gain_of_a_cause(false) + 50.0);
}

// Numbers that float take up the model's own error. Every fit of the recording then counts so.
TEST(Evidence, CountsWhatIsLeftBelowTheFloorWhereTheBenchsNumbersFloat) {
    const Known known;
    Evidence beside_floating_numbers(200.0);
    beside_floating_numbers.set_below_noise_weight(below_noise_weight_beside_floating_numbers);
    const ScoredFit none = fitted(beside_floating_numbers, {&known.none}, 0.5, {0.0});
    const ScoredFit drag = fitted(beside_floating_numbers, {&known.drag}, 0.25, {1.0});
    EXPECT_GT(drag.evidence - none.evidence, 60.0);
}

// On a measured bench the model's own error hides what is smaller; where numbers float they take up a part
// of it.
TEST(Evidence, AFaintCauseCostsLessWhereTheBenchsNumbersFloat) {
    const Known known;
    BenchKnowledge floating;
    floating.numbers.resize(nominal_coordinates + 1);
    const auto cost_of_faintness = [&](const BenchKnowledge* bench) {
        ScoredFit clear = fitted(evidence, {&known.drag}, 0.9, {1.0});
        ScoredFit faint = fitted(evidence, {&known.drag}, 0.9, {0.5});
        for (ScoredFit* each : {&clear, &faint}) {
            if (bench != nullptr) each->fit.bench = bench;
            each->evidence = evidence.of(*each);
        }
        return clear.evidence - faint.evidence;
    };
    EXPECT_GT(cost_of_faintness(nullptr), 2.0 * cost_of_faintness(&floating));
    EXPECT_GT(cost_of_faintness(&floating), 1.0);
}

// What the values of a channel show needs no inference, however faint it is.
TEST(Evidence, NamesAFaintCauseThatIsSeen) {
    Known known;
    const auto probability_of_steps = [&] {
        return probability(ranked_by(evidence, {known.none, known.gain},
                                     {fitted(evidence, {&known.none}, 0.5, {0.0}),
                                      fitted(evidence, {&known.gain}, 0.45, {0.3})}),
                           "sensor_gain");
    };
    EXPECT_LT(probability_of_steps(), 0.1);
    known.gain.is_seen = true;
    EXPECT_GT(probability_of_steps(), nearly_certain);
}

// A discrepancy in proportion to a small error of unknown scale is as small as that error.
TEST(Evidence, StructureBelowNoiseAndFloorIsNotAnUnknownCause) {
    const Known known;
    const auto probability_of_unknown = [&](double misfit) {
        ScoredFit none = fitted(evidence, {&known.none}, misfit, {0.0});
        none.has_unknown_scales = true;
        for (std::size_t k = 3; k < discrepancy_sizes.size(); ++k) none.beside[k] = {0.3 * misfit, 20.0};
        none.evidence = evidence.of(none);
        return probability(ranked_by(evidence, {known.none}, {none}), "unknown");
    };
    EXPECT_LT(probability_of_unknown(0.05), 0.1);
    EXPECT_GT(probability_of_unknown(20.0), nearly_certain);
}

TEST(Evidence, OfCausesThatActTogetherTheClearerOneLeads) {
    const Known known;
    for (const double of_gain : {2.0, 9.0}) {
        const auto ranked = ranked_by(evidence, {known.none, known.drag, known.gain},
                                      {fitted(evidence, {&known.none}, 20.0, {0.0}),
                                       fitted(evidence, {&known.drag, &known.gain}, 1.0, {5.0, of_gain})});
        EXPECT_EQ(ranked.front().effect, of_gain > 5.0 ? "sensor_gain" : "viscous_friction");
        EXPECT_NEAR(ranked[0].probability, ranked[1].probability, 1e-12);
    }
}

TEST(Evidence, FavoursTheCauseThatLeavesOnlyNoise) {
    const Known known;
    const auto ranked =
        ranked_by(evidence, {known.none, known.drag, known.gain},
                  {fitted(evidence, {&known.none}, 5.0, {0.0}), fitted(evidence, {&known.drag}, 1.0, {4.0}),
                   fitted(evidence, {&known.gain}, 3.0, {3.0})});
    EXPECT_EQ(ranked.front().effect, "viscous_friction");
    EXPECT_EQ(ranked[1].effect, "unknown");
}

TEST(Evidence, UnusualNumbersLowerTheEvidenceByTheirPenalty) {
    const Known known;
    const ScoredFit usual = fitted(evidence, {&known.drag}, 1.0, {4.0});
    ScoredFit odd = usual;
    odd.shape_penalty = 10.0;  // a number e^4.5 times what is usual
    EXPECT_NEAR(usual.evidence - evidence.of(odd), odd.shape_penalty, 1e-12);
}

// Residuals that are a function of the motion, as those of a cause outside the list are.
ScoredFit with_structure(ScoredFit fit) {
    for (std::size_t k = 0; k < fit.beside.size(); ++k) {
        const double variance = std::pow(discrepancy_sizes[k], 2);
        fit.beside[k].misfit = 1.0 + (fit.misfit - 1.0) / (1.0 + 10.0 * variance);
    }
    fit.evidence = evidence.of(fit);
    return fit;
}

TEST(Evidence, UnexplainedStructureIsReportedAsUnknown) {
    const Known known;
    const auto ranked = ranked_by(evidence, {known.none, known.drag},
                                  {with_structure(fitted(evidence, {&known.none}, 9.0, {0.0})),
                                   with_structure(fitted(evidence, {&known.drag}, 8.5, {3.0}))});
    EXPECT_EQ(ranked.front().effect, "unknown");
    EXPECT_GT(ranked.front().present, nearly_certain);
}

// Friction and pretension change the same tension, and either may be what follows the condition.
TEST(Evidence, AnEffectFollowsAConditionWhereThatIsMoreProbableThanNot) {
    Known known;
    CandidateCause pretension = known.drag;
    pretension.effect = "param_T0";
    known.drag.varies = pretension.varies = "roll_deg";
    const auto condition_of_drag = [&](double left_by_pretension) {
        const auto ranked = ranked_by(evidence, {known.none, known.drag, pretension},
                                      {fitted(evidence, {&known.drag}, 1.0, {8.0}),
                                       fitted(evidence, {&pretension}, left_by_pretension, {8.0})});
        EXPECT_GT(present(ranked, "viscous_friction"), 0.4);
        return ranked.front().effect == "viscous_friction" ? ranked.front().varies : ranked[1].varies;
    };
    EXPECT_EQ(condition_of_drag(1.2), "roll_deg");
    EXPECT_EQ(condition_of_drag(1.0), "");
}

TEST(Evidence, ACauseThatLeavesStructureIsNamedBesideTheUnknown) {
    const Known known;
    ScoredFit drag = with_structure(fitted(evidence, {&known.drag}, 60.0, {8.0}));
    ScoredFit nothing = with_structure(fitted(evidence, {&known.none}, 120.0, {0.0}));
    for (Marginal& each : nothing.beside) each.misfit += 1.0;  // more than a function of the motion
    const auto ranked = ranked_by(evidence, {known.none, known.drag}, {nothing, drag});
    EXPECT_GT(ranked[0].present, 0.8);
    EXPECT_GT(ranked[1].present, 0.8);
    EXPECT_NEAR(ranked[0].probability, ranked[1].probability, 0.01);
}

// The first of `channels` channels leaves `most`, the others only noise. `any_gains`: what an error of any
// kind explains of the means of blocks.
ScoredFit with_channels(const Evidence& by, ScoredFit fit, std::size_t channels, double most,
                        double any_gains = 0.0) {
    fit.channel_misfits.assign(channels, 1.0);
    fit.channel_misfits.front() = most;
    fit.of_blocks = BlockLikelihoods{};
    fit.of_blocks->beside_any = any_gains;
    fit.evidence = by.of(fit);
    return fit;
}

TEST(Evidence, WhatOneChannelLeavesWithoutFollowingTheMotionIsUnknown) {
    const Known known;
    // Seven channels, of which one leaves five times its variance: 1.57 on average.
    const double mean_square = (6.0 + 5.0) / 7.0;
    const ScoredFit nothing =
        with_channels(evidence, fitted(evidence, {&known.none}, mean_square, {0.0}), 7, 5.0, 60.0);
    const ScoredFit drag =
        with_channels(evidence, fitted(evidence, {&known.drag}, 0.99 * mean_square, {2.5}), 7, 4.9, 60.0);
    const auto ranked = ranked_by(evidence, {known.none, known.drag}, {nothing, drag});
    EXPECT_EQ(ranked.front().effect, "unknown");
    EXPECT_GT(ranked.front().probability, nearly_certain);
}

TEST(Evidence, ScatterOfTheNoisesScaleIsNoUnknownCause) {
    const Known known;
    for (const double mean_square : {0.6, 1.0, 1.2}) {
        const ScoredFit nothing =
            with_channels(evidence, fitted(evidence, {&known.none}, mean_square, {0.0}), 1, mean_square);
        const auto ranked = ranked_by(evidence, {known.none, known.drag}, {nothing});
        EXPECT_EQ(ranked.front().effect, "none") << mean_square;
        EXPECT_LT(probability(ranked, "unknown"), 0.03) << mean_square;
    }
}

TEST(Evidence, ALawMayBeWrongByATenthOfWhatItsCauseDoes) {
    const Known known;
    // A cause of twenty times the noise may leave a channel's variance at five times the noise's. Of the
    // sizes of an error of any kind one in twenty explains that.
    const double one_size = -std::log(20.0);
    const auto unknown_is_present = [&](double visibility) {
        const ScoredFit nothing =
            with_channels(evidence, fitted(evidence, {&known.none}, 200.0, {0.0}), 1, 200.0, one_size);
        const ScoredFit drag =
            with_channels(evidence, fitted(evidence, {&known.drag}, 5.0, {visibility}), 1, 5.0, one_size);
        return present(ranked_by(evidence, {known.none, known.drag}, {nothing, drag}), "unknown");
    };
    EXPECT_LT(unknown_is_present(20.0), mistaken_cause_fraction / 3.0 + 0.01);
    // That the noise is wrongly stated is about as probable as a further cause.
    EXPECT_NEAR(unknown_is_present(3.0), 0.5, 0.3);
}

TEST(Evidence, AWrongStatementOfTheNoiseDoesNotChooseAmongNamedCauses) {
    const Known known;
    const ScoredFit drag = with_channels(evidence, fitted(evidence, {&known.drag}, 20.0, {9.0}), 2, 39.0);
    const ScoredFit gain = with_channels(evidence, fitted(evidence, {&known.gain}, 21.0, {9.0}), 2, 22.0);
    const double by_likelihood = fitted(evidence, {&known.drag}, 20.0, {9.0}).evidence -
                                 fitted(evidence, {&known.gain}, 21.0, {9.0}).evidence;
    EXPECT_NEAR(drag.evidence - gain.evidence, by_likelihood, 1e-9);
}

TEST(Evidence, AnUnknownCauseHasTheShareOfTheGapThatTheNamedOneLeaves) {
    const Known known;
    // Of eight times the noise's variance the drag closes two.
    const std::vector<ScoredFit> fits = {
        with_channels(evidence, fitted(evidence, {&known.none}, 9.0, {0.0}), 1, 9.0),
        with_channels(evidence, fitted(evidence, {&known.drag}, 7.0, {2.5}), 1, 7.0)};
    std::vector<WeighedHypothesis> weighed = evidence.weigh(fits);
    std::erase_if(weighed, [](const WeighedHypothesis& each) { return each.effects.size() != 2; });
    ASSERT_EQ(weighed.size(), 1U);
    EXPECT_TRUE(weighed.front().with_unknown);
    EXPECT_NEAR(weighed.front().unknown_fraction, 0.75, 1e-12);
    weighed.front().probability = 1.0;
    // What is left for a mistake is left to all three effects alike.
    EXPECT_NEAR(probability(Evidence::rank({known.none, known.drag}, weighed), "unknown"),
                (1.0 - mistaken_cause_fraction) * 0.75 + mistaken_cause_fraction / 3.0, 1e-9);
}

const BenchKnowledge& bench_with_a_zero() {
    static const BenchKnowledge bench = [] {
        BenchKnowledge built = measured_bench();
        built.numbers.push_back({.name = "zero", .effect = "sensor_offset"});
        return built;
    }();
    return bench;
}

// Beside numbers that float a law follows the model's own error more easily, so that a further cause has to
// gain more.
TEST(Evidence, AFurtherCauseCostsMoreBesideFloatingNumbers) {
    const Known known;
    const auto charge_of = [&](const BenchKnowledge* bench, std::vector<const CandidateCause*> causes) {
        std::vector<double> visibility(causes.size(), 4.0);
        ScoredFit fit = fitted(evidence, std::move(causes), 0.9, std::move(visibility));
        if (bench != nullptr) fit.fit.bench = bench;
        const double before = fit.evidence;
        fit.charge_further_causes();
        return before - fit.evidence;
    };
    EXPECT_EQ(charge_of(nullptr, {&known.drag, &known.gain}), 0.0);
    EXPECT_EQ(charge_of(&bench_with_a_zero(), {&known.drag}), 0.0);
    EXPECT_GT(charge_of(&bench_with_a_zero(), {&known.drag, &known.gain}), std::log(1000.0));
}

TEST(Evidence, AUsualDelayHasToGainWhatACauseOfItsPlaceDoes) {
    const Known known;
    const auto log_odds = [](std::vector<const CandidateCause*> causes, double deviations,
                             double visibility) {
        CauseFit fit;
        fit.causes = std::move(causes);
        return log_odds_of_usual_number(fit, deviations, visibility);
    };
    EXPECT_GT(log_odds({&known.none}, 3.0, 1.0), std::log(20.0));
    EXPECT_LT(log_odds({&known.drag}, 3.0, 1.0), -std::log(20.0));
    EXPECT_GT(log_odds({&known.drag}, 5.0, 1.0), std::log(20.0));
    EXPECT_LT(log_odds({&known.none}, 3.0, 0.1), -std::log(10.0)) << "changes nothing that shows";
}

// It may stand for what the law of the clearer one, or a number that floats, is wrong by. The difference is
// that fraction of what mistakes and other explanations leave, which is more than eight tenths.
TEST(Evidence, AnEffectBesideAClearerOneIsLessCertainWhereNumbersFloat) {
    const Known known;
    const auto more_certain = [&](const BenchKnowledge* bench) {
        ScoredFit both = fitted(evidence, {&known.drag, &known.gain}, 1.0, {9.0, 4.0});
        if (bench != nullptr) both.fit.bench = bench;
        const std::vector<RankedEffect> ranked = ranked_by(evidence, {known.drag, known.gain}, {both});
        EXPECT_NEAR(probability(ranked, known.drag.effect), probability(ranked, known.gain.effect), 1e-9);
        return present(ranked, known.drag.effect) - present(ranked, known.gain.effect);
    };
    EXPECT_NEAR(more_certain(nullptr), 0.0, 1e-9);
    EXPECT_NEAR(more_certain(&bench_with_a_zero()), mistaken_beside_a_clearer_one,
                0.2 * mistaken_beside_a_clearer_one);
}

TEST(Evidence, AnAnswerCountsCausesOutsideTheCanonicalListAsUnknown) {
    const std::vector<RankedEffect> ranked = {{"directional_friction", 0.4, 0.5},
                                              {"stribeck", 0.35, 0.6, "roll_deg"},
                                              {"unknown", 0.2, 0.25},
                                              {"none", 0.05, 0.05}};
    const std::vector<RankedEffect> answered = in_answered_names(ranked);
    ASSERT_EQ(answered.size(), 3U);
    EXPECT_EQ(answered[0].effect, "unknown");
    EXPECT_DOUBLE_EQ(answered[0].probability, 0.6);
    EXPECT_DOUBLE_EQ(answered[0].present, 0.75);
    EXPECT_EQ(answered[1].effect, "stribeck");
    EXPECT_EQ(answered[1].varies, "roll_deg");
    EXPECT_EQ(answered[2].effect, "none");
}

// A fit of the bench as built, which left the friction far off with this probability.
TEST(Evidence, AFarNumberIsPresentAsProbablyAsItIsFar) {
    const Known known;
    const auto ranked_where_far = [&](double probability) {
        ScoredFit nothing = fitted(evidence, {&known.none}, 1.0, {0.0});
        nothing.fit.bench = &bench_with_a_zero();
        nothing.far_numbers = {{0, probability}};
        return ranked_by(evidence, {known.none, known.drag}, {nothing});
    };
    EXPECT_GT(present(ranked_where_far(1.0), "param_mu"), nearly_certain);
    EXPECT_NEAR(present(ranked_where_far(0.3), "param_mu") - present(ranked_where_far(0.0), "param_mu"),
                0.3 * (1.0 - mistaken_cause_fraction), 0.05);
    EXPECT_GT(probability(ranked_where_far(0.3), "none"), probability(ranked_where_far(0.9), "none"));
    EXPECT_EQ(ranked_where_far(0.3).front().effect, "none");
}

// A bench's own number took up a delay far beyond what is usual of a force sensor, which needs no cause. It
// explains the same as that delay as a cause, which has a larger penalty, and is less probable than a lag.
TEST(Evidence, ADelayThatIsFarBeyondTheUsualIsWeighedAsTheCauseThatItIs) {
    const Known known;
    CandidateCause delay = known.gain;
    delay.effect = "time_misalignment";
    delay.variant = "load_torque";
    CandidateCause lag = delay;
    lag.effect = "sensor_lag";
    BenchKnowledge bench = bench_with_a_zero();
    bench.numbers.push_back({.name = "time",
                             .prior_std = 0.5,
                             .usual = 1.0,
                             .effect = "time_misalignment",
                             .variant = "load_torque"});
    const auto of_the_bench = [&](std::vector<const CandidateCause*> causes, double evidence_of_it) {
        std::vector<double> visibility(causes.size(), 3.0);
        ScoredFit fit = fitted(evidence, std::move(causes), 1.0, std::move(visibility));
        fit.fit.bench = &bench;
        fit.evidence = evidence_of_it;
        return fit;
    };
    ScoredFit taken_up = of_the_bench({&known.drag}, 4.0);
    taken_up.far_numbers = {{bench.numbers.size() - 1, 1.0}};
    const ScoredFit late = of_the_bench({&known.drag, &delay}, 0.0);
    const ScoredFit slow = of_the_bench({&known.drag, &lag}, 3.0);
    const std::vector<CandidateCause> causes = {known.drag, delay, lag};
    EXPECT_GT(present(ranked_by(evidence, causes, {taken_up, slow}), "time_misalignment"), 0.5);
    const auto ranked = ranked_by(evidence, causes, {taken_up, slow, late});
    EXPECT_GT(present(ranked, "sensor_lag"), 0.7);
    EXPECT_LT(present(ranked, "time_misalignment"), 0.3);
    // One that is usual, but clear, is likely on any bench as built, and needs no cause.
    taken_up.far_numbers.front().is_usual = true;
    EXPECT_GT(present(ranked_by(evidence, causes, {taken_up, slow, late}), "time_misalignment"), 0.5);
}

// The law of a drag that changes a channel by ten times noise and floor is good to once that.
TEST(Evidence, AFarNumberThatOnlyCorrectsTheLawOfACauseIsNotNamed) {
    Known known;
    const auto far_where_it_closes = [&](const CandidateCause& cause, double closes) {
        ScoredFit fit = fitted(evidence, {&cause}, 1.0, {10.0});
        fit.fit.bench = &bench_with_a_zero();
        fit.far_numbers = {{2, 0.9, closes}};
        return present(ranked_by(evidence, {known.none, known.drag, known.gain}, {fit}), "param_T0");
    };
    EXPECT_GT(far_where_it_closes(known.drag, 1.1), 0.8);
    EXPECT_LT(far_where_it_closes(known.drag, 0.3), 0.1);
    known.gain.is_exact = true;
    EXPECT_GT(far_where_it_closes(known.gain, 0.3), 0.8);
}

// The floor is known to a quarter, and a number that closes less may only follow the model's own error.
TEST(Evidence, AFarNumberThatClosesLessThanTheFloorMayBeWrongByIsNotNamed) {
    const Known known;
    const auto far_where_it_closes = [&](double closes) {
        ScoredFit nothing = fitted(evidence, {&known.none}, 1.0, {0.0});
        nothing.fit.bench = &bench_with_a_zero();
        nothing.far_numbers = {{2, 0.9, closes}};
        return present(ranked_by(evidence, {known.none, known.drag}, {nothing}), "param_T0");
    };
    EXPECT_GT(far_where_it_closes(0.25), 0.75);
    EXPECT_LT(far_where_it_closes(0.1), far_where_it_closes(0.0) + 0.1);
}

// A pretension of e^-0.08 of what was stated, known to a hundredth by the fit and to a twentieth by the
// scatter between runs. Where nothing but numbers acts, there is no law that a number could correct.
TEST(Evidence, BesideALawAStatedNumberIsNoMoreCertainThanItsInterval) {
    const Known known;
    BenchKnowledge bench = bench_with_a_zero();
    for (FloatingNumber& number : bench.numbers) {
        number.prior_std = 0.15;
        number.measured_std = nominal_log_std;
    }
    const auto wrong_where_known_to = [&](const CandidateCause& cause, double deviation) {
        ScoredFit fit = fitted(evidence, {&cause}, 1.0, {cause.effect == "none" ? 0.0 : 10.0});
        fit.fit.bench = &bench;
        fit.fit.coordinates = Eigen::Vector4d(0.0, 0.0, -0.08, 0.0);
        fit.fit.nominal_covariance = 1e-4 * Eigen::Matrix3d::Identity();
        fit.far_numbers = {{2, 0.9}};
        fit.widen_stated_numbers(Eigen::Vector3d::Constant(deviation));
        return fit.probability_of(fit.far_numbers.front());
    };
    EXPECT_GT(wrong_where_known_to(known.drag, 0.005), 0.9);
    EXPECT_EQ(wrong_where_known_to(known.drag, 0.005), wrong_where_known_to(known.drag, 0.01));
    EXPECT_LT(wrong_where_known_to(known.drag, 0.05), 0.5);
    EXPECT_EQ(wrong_where_known_to(known.none, 0.05), 0.9);
}

TEST(Evidence, BesideFloatingNumbersACauseTooFaintToShowIsAsProbableAsNone) {
    const Known known;
    const std::vector<CandidateCause> causes = {known.none, known.drag, known.gain};
    ScoredFit nothing = fitted(evidence, {&known.none}, 1.0, {0.0});
    const auto measured = ranked_by(evidence, causes, {nothing});
    nothing.fit.bench = &bench_with_a_zero();
    const auto built = ranked_by(evidence, causes, {nothing});
    EXPECT_GT(present(measured, "none"), 0.9);
    EXPECT_NEAR(present(built, "none"), 0.5 * present(measured, "none"), 0.02);
    EXPECT_EQ(built.front().effect, "none");
    EXPECT_NEAR(probability(built, "viscous_friction"), probability(built, "sensor_gain"), 1e-12);
    double sum = 0.0;
    for (const RankedEffect& each : built) {
        EXPECT_LE(each.probability, each.present + 1e-12) << each.effect;
        sum += each.probability;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(Evidence, NoneIsNotThereWhereANumberOfTheBenchIsTheCause) {
    const Known known;
    const auto none_where_usual = [&](double usual) {
        ScoredFit nothing = fitted(evidence, {&known.none}, 1.0, {0.0});
        nothing.fit.bench = &bench_with_a_zero();
        nothing.far_numbers = {{2, 1.0}};
        nothing.far_numbers_are_usual = usual;
        return ranked_by(evidence, {known.none, known.drag}, {nothing});
    };
    const auto alone = none_where_usual(0.0);
    EXPECT_EQ(alone.front().effect, "param_T0");
    EXPECT_LT(present(alone, "none"), 0.05);
    EXPECT_NEAR(present(none_where_usual(0.5), "none"), 0.5 * present(none_where_usual(1.0), "none"), 0.02);
}

TEST(Evidence, APairLeadsOnlyIfBothCausesAreVisible) {
    const Known known;
    const ScoredFit single = fitted(evidence, {&known.drag}, 2.0, {6.0});
    const ScoredFit both = fitted(evidence, {&known.drag, &known.gain}, 1.0, {6.0, 4.0});
    const ScoredFit faint = fitted(evidence, {&known.drag, &known.gain}, 1.0, {6.0, 0.2});
    EXPECT_GT(both.evidence, single.evidence);
    EXPECT_LT(faint.evidence, both.evidence - 40.0);
    const auto ranked = ranked_by(evidence, {known.none, known.drag, known.gain}, {single, both});
    EXPECT_NEAR(probability(ranked, "viscous_friction"), probability(ranked, "sensor_gain"), 0.01);
}

// E70. What a fit leaves of two channels whose floors are 0.25 and 0.64 of the square of noise and floor.
ScoredFit with_floors(ScoredFit fit, std::vector<double> left) {
    fit.of_blocks = BlockLikelihoods{};
    fit.channel_misfits = std::move(left);
    fit.channel_floors = {0.25, 0.64};
    return fit;
}

// The means of blocks are so sharp that they also see what the model itself is wrong by.
TEST(Evidence, ACauseThatClosesLessThanTheFloorIsCharged) {
    const Known known;
    const ScoredFit nothing = with_floors(fitted(evidence, {&known.none}, 1.0, {0.0}), {2.0, 2.0});
    const auto charge = [&](std::vector<double> left) {
        ScoredFit drag = with_floors(fitted(evidence, {&known.drag}, 1.0, {1.0}), std::move(left));
        drag.evidence = nothing.evidence + 60.0;
        return evidence.penalty_of_corrections(drag, {nothing});
    };
    // The model's error may be 1.4 times the floor.
    EXPECT_NEAR(charge({2.0 - 1.96 * 0.25, 2.0}), 0.0, 1e-9) << "all of one channel's";
    EXPECT_EQ(charge({2.0, 0.7}), 0.0);
    EXPECT_NEAR(charge({2.0, 2.0 - 0.25 * 1.96 * 0.64}), 40.0 * 0.5, 1e-9) << "half of the other's";
    EXPECT_NEAR(charge({2.0, 2.1}), 40.0, 1e-9) << "nothing";
    const ScoredFit drag = with_floors(fitted(evidence, {&known.drag}, 1.0, {1.0}), {2.0, 1.9});
    EXPECT_EQ(evidence.penalty_of_corrections(drag, {}), 0.0) << "nothing tells what is left without it";
    const BenchKnowledge& built = bench_with_a_zero();
    ScoredFit elsewhere = nothing;
    elsewhere.fit.bench = &built;
    EXPECT_EQ(evidence.penalty_of_corrections(drag, {elsewhere}), 0.0) << "on another bench";
}

// Numbers that float take up a part of the model's error.
TEST(Evidence, BesideFloatingNumbersACauseFollowsHalfOfTheFloorAtMost) {
    const Known known;
    const auto as_built = [](ScoredFit fit) {
        fit.fit.bench = &bench_with_a_zero();
        return fit;
    };
    const ScoredFit nothing = as_built(with_floors(fitted(evidence, {&known.none}, 1.0, {0.0}), {2.0, 2.0}));
    const auto charge = [&](double closed_of_floor) {
        const double left = 2.0 - std::pow(closed_of_floor, 2) * 1.96 * 0.25;
        return evidence.penalty_of_corrections(
            as_built(with_floors(fitted(evidence, {&known.drag}, 1.0, {1.0}), {left, 2.0})), {nothing});
    };
    EXPECT_NEAR(charge(0.51), 0.0, 1e-9);
    EXPECT_NEAR(charge(0.25), 40.0, 1e-9);
    EXPECT_NEAR(charge(0.0), 80.0, 1e-9);
}

// A drive's errors have no known scale, but where no more than noise and floor is left, what closes less than
// the floor is known to is the model's.
TEST(Evidence, OfAnUnknownScaleACauseThatClosesLessThanTheFloorIsKnownToIsCharged) {
    const Known known;
    const auto with_unknown_scales = [](ScoredFit fit) {
        fit.has_unknown_scales = true;
        return fit;
    };
    const auto charge = [&](double without, double with) {
        const ScoredFit nothing = with_unknown_scales(fitted(evidence, {&known.none}, without, {0.0}));
        const ScoredFit drag = with_unknown_scales(fitted(evidence, {&known.drag}, with, {1.0}));
        return evidence.penalty_of_corrections(drag, {nothing});
    };
    EXPECT_NEAR(charge(0.5, 0.5 - 0.25 * 0.25), 0.0, 1e-9);
    EXPECT_NEAR(charge(0.5, 0.5 - 0.125 * 0.125), 4.0, 1e-9);
    EXPECT_NEAR(charge(0.5, 0.5), 8.0, 1e-9);
    EXPECT_EQ(charge(5.0, 5.0), 0.0) << "the model's error exceeds the floor, and may be anything";
}

// What a strong cause leaves because its law is an idealisation is no second cause. A sensor's gain has no
// such law, and a law that stands for an effect outside the list is only good to a half.
TEST(Evidence, ACauseThatOnlyCorrectsTheLawOfAnotherIsCharged) {
    Known known;
    const auto charge = [&](double visibility) {
        const ScoredFit drag = with_floors(fitted(evidence, {&known.drag}, 1.0, {visibility}), {1.25, 1.16});
        const ScoredFit both =
            with_floors(fitted(evidence, {&known.drag, &known.gain}, 1.0, {visibility, 1.0}), {1.0, 1.16});
        return evidence.penalty_of_corrections(both, {drag});
    };
    const auto expected = [](double law) {
        return 40.0 * (1.0 - std::sqrt(0.25 / (1.96 * 0.25 + law * law)));
    };
    EXPECT_NEAR(charge(8.0), expected(0.1 * 8.0), 1e-9);
    known.drag.is_outside_the_list = true;
    EXPECT_NEAR(charge(8.0), expected(0.5 * 8.0), 1e-9);
    known.drag.is_exact = true;
    EXPECT_NEAR(charge(8.0), expected(0.0), 1e-9);
}

// A number that no bench has says so whatever the residuals follow; beside a law it may only correct that.
TEST(Evidence, ACauseWithoutWhichNumbersAreFarOffIsChargedLittle) {
    Known known;
    known.gain.is_exact = true;
    const double far = 30.0;
    const double usual = 3.0;
    const auto charge = [&](std::vector<const CandidateCause*> others, double nominal_penalty,
                            double closes = 0.0) {
        std::vector<double> visibility(others.size(), others.front() == &known.none ? 0.0 : 4.0);
        ScoredFit without = with_floors(fitted(evidence, others, 1.0, visibility), {1.0, 1.0});
        without.nominal_penalty = nominal_penalty;
        without.evidence -= nominal_penalty;
        if (closes > 0.0) without.far_numbers = {{2, 0.99, closes}};
        std::erase(others, &known.none);
        others.push_back(&known.gain);
        visibility.assign(others.size(), 4.0);
        const ScoredFit with = with_floors(fitted(evidence, others, 1.0, visibility), {1.0, 1.0});
        return evidence.penalty_of_corrections(with, {without});
    };
    EXPECT_LT(charge({&known.none}, far), 3.9);
    EXPECT_NEAR(charge({&known.none}, usual), 40.0, 1e-9) << "one bench in twenty is farther off";
    // The law of the drag is good to 0.4 times noise and floor, and numbers that close less may correct it.
    EXPECT_NEAR(charge({&known.drag}, far, 0.1), 40.0, 1e-9);
    EXPECT_LT(charge({&known.drag}, far, 1.0), 3.9);
    EXPECT_NEAR(charge({&known.drag}, usual, 1.0), 40.0, 1e-9);
}

// In a search a set is weighed again whenever a smaller one becomes known.
TEST(Evidence, WhatACauseIsChargedDoesNotDependOnWhatWasChargedBefore) {
    Known known;
    known.gain.is_exact = true;
    ScoredFit without = with_floors(fitted(evidence, {&known.none}, 1.0, {0.0}), {1.0, 1.0});
    without.nominal_penalty = 30.0;
    without.evidence -= without.nominal_penalty;
    ScoredFit with = with_floors(fitted(evidence, {&known.gain}, 1.0, {4.0}), {0.99, 1.0});
    with.evidence = without.evidence + without.nominal_penalty + 5.0;
    const double once = evidence.penalty_of_corrections(with, {without});
    EXPECT_GT(once, 5.0);
    with.charge_unproven(once);
    without.charge_unproven(7.0);
    EXPECT_NEAR(evidence.penalty_of_corrections(with, {without}), once, 1e-9);
}

// The same number moves without the cause as well, as far as its prior lets it.
TEST(Evidence, AWrongNumberIsNotChargedWhereItIsFarOffWithoutTheCause) {
    Known known;
    CandidateCause friction = known.none;
    friction.effect = "param_mu";
    friction.is_exact = true;
    const auto charge = [&](double nominal_penalty) {
        ScoredFit without = with_floors(fitted(evidence, {&known.none}, 1.0, {0.0}), {1.0, 1.0});
        without.nominal_penalty = nominal_penalty;
        without.evidence -= nominal_penalty;
        ScoredFit with = with_floors(fitted(evidence, {&friction}, 1.0, {8.0}), {0.99, 1.0});
        with.evidence = without.evidence + nominal_penalty + 7.0;
        return evidence.penalty_of_corrections(with, {without});
    };
    EXPECT_EQ(charge(60.0), 0.0);
    EXPECT_GT(charge(3.0), 20.0) << "one bench in twenty is farther off";
    friction.is_of_runs = true;
    EXPECT_GT(charge(60.0), 3.9) << "numbers that differ between runs are further ones";
}

// A loop of a sensor follows the model's own error of that channel best.
TEST(Evidence, BesideMeansOfBlocksAFaintFaultOfAReadingIsNone) {
    Known known;
    known.gain.family = "sensor";
    const auto gained = [&](const CandidateCause& cause, double visibility) {
        ScoredFit fit = fitted(evidence, {&cause}, 1.0, {visibility});
        const double before = fit.evidence;
        fit.of_blocks = BlockLikelihoods{};
        return evidence.of(fit) - before;
    };
    EXPECT_NEAR(gained(known.gain, 0.4), -200.0 * 0.6, 1e-9);
    EXPECT_EQ(gained(known.gain, 1.0), 0.0);
    EXPECT_EQ(gained(known.drag, 0.4), 0.0);
}

// A bench has several zeros and bearings' friction, whether they were searched as causes or float.
TEST(Evidence, SeveralUsualNumbersSayNothingAgainstNone) {
    Known known;
    known.gain.effect = "sensor_offset";
    known.drag.effect = "pulley_friction";
    const std::vector<CandidateCause> causes = {known.none, known.drag, known.gain};
    const ScoredFit nothing = fitted(evidence, {&known.none}, 9.0, {0.0});
    const ScoredFit zero = fitted(evidence, {&known.gain}, 1.0, {4.0});
    EXPECT_LT(present(ranked_by(evidence, causes, {zero, nothing}), "none"), 0.05);
    const ScoredFit zero_and_bearing = fitted(evidence, {&known.drag, &known.gain}, 1.0, {4.0, 4.0});
    EXPECT_TRUE(names_only_the_bench(nothing));
    EXPECT_FALSE(names_only_the_bench(zero));
    EXPECT_TRUE(names_only_the_bench(zero_and_bearing));
    const auto both = ranked_by(evidence, causes, {nothing, zero_and_bearing});
    EXPECT_GT(present(both, "sensor_offset"), nearly_certain);
    EXPECT_NEAR(present(both, "none"), 0.5, 0.05);
    EXPECT_EQ(both[2].effect, "none");
    EXPECT_GT(both[2].probability, probability(both, "unknown"));
}

TEST(Evidence, ProbabilitiesSumToOneAndNoneIsZero) {
    const Known known;
    const auto ranked = ranked_by(
        evidence, {known.none, known.drag, known.gain},
        {fitted(evidence, {&known.none}, 50.0, {0.0}), fitted(evidence, {&known.drag}, 0.9, {9.0})});
    double sum = 0.0;
    for (const RankedEffect& each : ranked) {
        EXPECT_GT(each.probability, 0.0);
        sum += each.probability;
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
}

}  // namespace
}  // namespace capstan::gap
