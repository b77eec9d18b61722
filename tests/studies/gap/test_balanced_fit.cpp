// Fits of a bench whose model is wrong by far more than its sensors' noise.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "capstan/gap/bench_knowledge.h"
#include "capstan/gap/cause_fit.h"
#include "capstan/gap/equivalent_bench.h"
#include "lumped_session.h"

namespace capstan::gap {
namespace {

class DriveWithAnErrorInItsTorque : public testing::Test {
  protected:
    // A ripple of six periods a turn that no number of the bench can follow. Both channels have little noise.
    DriveWithAnErrorInItsTorque() {
        Recording drive = lumped_session({});
        for (Channel& channel : drive.channels) channel.noise_std = channel.unit == "rad" ? 1e-3 : 1e-4;
        for (RecordedRun& run : drive.runs) {
            for (std::size_t sample = 0; sample < run.time_s.size(); ++sample)
                run.values[0][sample] += 0.2 * std::sin(6.0 * run.values[1][sample] + 1.0);
        }
        bench_ = equivalent_bench(drive, drive);
        knowledge_ = undescribed_bench(bench_);
    }

    CauseFit fitted(bool balanced) const {
        const CauseFitter fitter(bench_, {.segments = 12}, 1);
        CauseFitter::FitOptions options;
        options.any_size = false;
        options.balanced = balanced;
        return fitter.fit(nominal_hypothesis(knowledge_), options);
    }

    double rms(const CauseFit& fit, const std::string& channel) const {
        const CauseFitter fitter(bench_, {.segments = 12}, 1);
        double squares = 0.0;
        double rows = 0.0;
        for (const ResidualSeries& series : fitter.series()) {
            if (bench_.channels[series.channel].name != channel) continue;
            squares += fit.residuals
                           .segment(static_cast<Eigen::Index>(series.first_row),
                                    static_cast<Eigen::Index>(series.rows))
                           .squaredNorm();
            rows += static_cast<double>(series.determined_rows());
        }
        return std::sqrt(squares / rows);
    }

    Recording bench_;
    BenchKnowledge knowledge_;
};

TEST_F(DriveWithAnErrorInItsTorque, DoesNotSpoilTheFitOfTheAngle) {
    const CauseFit plain = fitted(false);
    const CauseFit balanced = fitted(true);
    ASSERT_GT(rms(balanced, "motor_torque"), 10.0) << "the ripple is not part of the model";
    EXPECT_LT(rms(balanced, "load_angle"), 0.7 * rms(plain, "load_angle"));
    EXPECT_LT(rms(balanced, "motor_torque"), 1.5 * rms(plain, "motor_torque"));
}

// A ripple keeps the number of periods that its search begins with: another one is another search.
TEST_F(DriveWithAnErrorInItsTorque, IsARippleOfAsManyPeriodsAsASearchBeginsWith) {
    const std::vector<CandidateCause> causes = candidate_causes(bench_);
    const auto ripple = std::find_if(causes.begin(), causes.end(), [](const CandidateCause& cause) {
        return cause.effect == "motor_cogging";
    });
    ASSERT_NE(ripple, causes.end());
    const CauseFitter fitter(bench_, {.segments = 12}, 1);
    CauseFitter::FitOptions options;
    options.any_size = false;
    options.balanced = true;
    std::map<double, double> misfits;
    for (const double periods : {5.0, 6.0, 40.0}) {
        Eigen::VectorXd numbers(ripple->numbers.size());
        std::transform(ripple->numbers.begin(), ripple->numbers.end(), numbers.begin(),
                       [&](const OpenNumber& number) {
                           if (number.kind == OpenNumber::Kind::periods) return periods;
                           return number.is_detail ? 0.0 : 1.0;
                       });
        const CauseFit fit =
            fitter.fit(with_cause(nominal_hypothesis(knowledge_), &*ripple, numbers), options);
        EXPECT_EQ(fit.coordinates[knowledge_.size() + 2], periods);
        misfits[periods] = fitter.misfit(fit);
    }
    EXPECT_LT(misfits[6.0], 0.1 * misfits[5.0]);
    EXPECT_LT(misfits[6.0], 0.1 * misfits[40.0]);
}

// The scale of its error is not known, so that no channel counts less because little is left of it (E54).
TEST_F(DriveWithAnErrorInItsTorque, IsWeighedByWhatIsLeftAlsoBelowNoiseAndFloor) {
    for (Channel& channel : bench_.channels) channel.noise_std = channel.unit == "rad" ? 10.0 : 1.0;
    const CauseFit fit = fitted(true);
    ASSERT_LT(rms(fit, "load_angle"), 0.1);
    const CauseFitter fitter(bench_, {.segments = 12}, 1);
    for (std::size_t k = 0; k < fit.weights.size(); ++k)
        EXPECT_NEAR(fit.weights[k] * rms(fit, bench_.channels[fitter.series()[k].channel].name), 1.0, 0.3);
}

TEST_F(DriveWithAnErrorInItsTorque, LeavesResidualsInUnitsOfNoise) {
    const CauseFit fit = fitted(true);
    const CauseFitter fitter(bench_, {.segments = 12}, 1);
    const Hypothesis found = fit.hypothesis();
    EXPECT_TRUE(fitter.data_residuals({&found, 1})
                    .col(0)
                    .isApprox(fit.residuals.head(static_cast<Eigen::Index>(fitter.data_rows())), 1e-9));
}

TEST_F(DriveWithAnErrorInItsTorque, LeavesFewerIndependentSamplesThanNoiseDoes) {
    CauseFitter fitter(bench_, {.segments = 12}, 1);
    const double usual = fitter.independent_samples();
    Eigen::VectorXd residuals = fitted(true).residuals;
    const std::map<std::size_t, double> of_errors_s = fitter.correlation_times_s(residuals);
    std::mt19937 generator(1);
    std::normal_distribution<double> noise;
    for (const ResidualSeries& series : fitter.series()) {
        for (std::size_t row = 0; row < series.rows; ++row)
            residuals[static_cast<Eigen::Index>(series.first_row + row)] =
                0.9 * std::sqrt(series.noise_part) * noise(generator);
    }
    const std::map<std::size_t, double> of_noise_s = fitter.correlation_times_s(residuals);
    const auto torque = static_cast<std::size_t>(*bench_.channel("motor_torque"));
    EXPECT_GT(of_errors_s.at(torque), 0.24);
    for (const auto& [channel, time_s] : of_noise_s) EXPECT_NEAR(time_s, 0.1, 1e-9) << channel;
    fitter.set_correlation_times(of_noise_s);
    EXPECT_NEAR(fitter.independent_samples(), usual * usual_correlation_time_s / 0.1, 1e-6 * usual);
}

TEST_F(DriveWithAnErrorInItsTorque, WeighsLessInABalancedFitThanAChannelWithNoiseAlone) {
    CauseFitter fitter(bench_, {.segments = 12}, 1);
    CauseFitter::FitOptions options;
    options.any_size = false;
    options.balanced = true;
    std::map<std::size_t, double> times_s;
    for (const ResidualSeries& series : fitter.series())
        times_s[series.channel] = bench_.channels[series.channel].name == "motor_torque" ? 0.25 : 0.1;
    const CauseFit alike = fitter.fit(nominal_hypothesis(knowledge_), options);
    fitter.set_correlation_times(times_s);
    const CauseFit weighed = fitter.fit(nominal_hypothesis(knowledge_), options);
    EXPECT_LT(rms(weighed, "load_angle"), rms(alike, "load_angle"));
}

}  // namespace
}  // namespace capstan::gap
