// How well the numbers of a fit are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "capstan/gap/cause_fit.h"
#include "session_with_effects.h"

namespace capstan::gap {
namespace {

constexpr double true_drag = 2.0;

Recording session_with_drag() {
    BenchNumbers numbers;
    numbers.effects.of<ViscousFriction>().drag_N_s_per_m2 = true_drag;
    return exact_session(numbers, coarse_twin);
}

// An error that stays for half a second, as a model's error does.
void add_slow_error(Recording& recording, double size) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    for (RecordedRun& run : recording.runs) {
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
            if (run.drives(recording.channels[channel].name)) continue;
            double error = 0.0;
            const auto hold = static_cast<std::size_t>(0.5 * recording.sample_rate_Hz);
            for (std::size_t sample = 0; sample < run.values[channel].size(); ++sample) {
                if (sample % hold == 0) error = size * normal(random);
                run.values[channel][sample] += error;
            }
        }
    }
}

struct DragFit {
    OpenNumber number;
    CauseFit fit;
    Eigen::VectorXd widths;

    double low() const { return number.value(fit.coordinates[3] - widths[3]); }
    double high() const { return number.value(fit.coordinates[3] + widths[3]); }
};

DragFit fit_drag(const Recording& recording) {
    const CauseFitter fitter(recording, coarse_twin, 1);
    const std::vector<CandidateCause> causes = candidate_causes(recording);
    for (const CandidateCause& cause : causes) {
        if (cause.effect != "viscous_friction") continue;
        Eigen::VectorXd start = Eigen::VectorXd::Zero(nominal_coordinates + 1);
        start[3] = 1.0;
        const CauseFit fit = fitter.fit({{&cause}, start}, {});
        return {cause.numbers.front(), fit, fitter.half_widths(fit, {})};
    }
    throw std::out_of_range("viscous_friction");
}

const CandidateCause& cause_named(const std::vector<CandidateCause>& causes, const std::string& effect) {
    return *std::find_if(causes.begin(), causes.end(),
                         [&](const CandidateCause& each) { return each.effect == effect; });
}

// Load-dependent friction with an exponent of 1 is Coulomb friction with another coefficient.
TEST(Visibility, ACauseWithoutASizeIsNotSeenByTheNominalNumberThatItLetsGoFar) {
    const Recording recording = session_with_drag();
    const CauseFitter fitter(recording, coarse_twin, 1);
    const std::vector<CandidateCause> causes = candidate_causes(recording);
    const auto visibility_of = [&](const std::string& effect) {
        const CandidateCause& cause = cause_named(causes, effect);
        CauseFit fit;
        fit.causes = {&cause};
        fit.coordinates =
            Eigen::VectorXd::Zero(nominal_coordinates + static_cast<Eigen::Index>(cause.numbers.size()));
        fit.coordinates[0] = 0.3;  // of the friction's logarithm
        return fitter.visibility(fit).of_causes.front();
    };
    EXPECT_GT(visibility_of("param_mu"), 2.0);
    EXPECT_LT(visibility_of("load_dependent_friction"), 1e-9);
}

TEST(FitIntervals, HoldTheTrueNumberAndGrowWithTheModelsError) {
    const DragFit exact = fit_drag(session_with_drag());
    EXPECT_LT(exact.low(), true_drag);
    EXPECT_GT(exact.high(), true_drag);
    Recording rough = session_with_drag();
    add_slow_error(rough, 0.05);
    const DragFit disturbed = fit_drag(rough);
    EXPECT_LT(disturbed.low(), true_drag);
    EXPECT_GT(disturbed.high(), true_drag);
    EXPECT_GT(disturbed.widths[3], 1.5 * exact.widths[3]);
}

// Without an error of the model, only noise and priors leave something open.
TEST(FitIntervals, OfNominalNumbersAreNeverWiderThanTheirPriorsOnAnExactRecording) {
    const DragFit exact = fit_drag(session_with_drag());
    for (int k = 0; k < nominal_coordinates; ++k) {
        EXPECT_GT(exact.widths[k], 0.0);
        EXPECT_LE(exact.widths[k], 1.96 * nominal_log_std * 1.0001);
    }
}

// A complete search without each run, and the few steps from the numbers and the Jacobian of all runs.
TEST(FitsWithoutEachRun, LeaveAsLittleAsCompleteSearchesAfterFewerEvaluations) {
    Recording recording = session_with_drag();
    add_slow_error(recording, 0.02);
    const CauseFitter fitter(recording, coarse_twin, 1);
    const std::vector<CandidateCause> causes = candidate_causes(recording);
    Eigen::VectorXd start = Eigen::VectorXd::Zero(nominal_coordinates + 1);
    start[nominal_coordinates] = 1.0;
    const CauseFit all = fitter.fit({{&cause_named(causes, "viscous_friction")}, start}, {});
    std::vector<LeftOut> runs;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) runs.push_back({run});
    const std::vector<CauseFit> quick = fitter.fits_without(all, runs);
    ASSERT_EQ(quick.size(), runs.size());
    for (std::size_t run = 0; run < runs.size(); ++run) {
        CauseFitter::FitOptions options;
        options.left_out = runs[run];
        options.any_size = false;
        const CauseFit complete = fitter.fit(all.hypothesis(), options);
        EXPECT_LT(quick[run].sum_of_squares, 1.001 * complete.sum_of_squares) << run;
        EXPECT_LT(quick[run].evaluations, complete.evaluations) << run;
    }
}

TEST(FitIntervals, TheJackknifeNeedsThreeRunsAndFollowsTheirSpread) {
    const auto one = [](double value) { return Eigen::VectorXd::Constant(1, value); };
    EXPECT_EQ(jackknife_half_widths({one(1.0), one(2.0)}, 1)[0], 0.0);
    // Leave-one-out values 1, 2, 3: standard error sqrt(2/3 * 2), Student's t of 2 degrees 4.303.
    EXPECT_NEAR(jackknife_half_widths({one(1.0), one(2.0), one(3.0)}, 1)[0], 4.303 * std::sqrt(4.0 / 3.0),
                2e-3);
}

}  // namespace
}  // namespace capstan::gap
