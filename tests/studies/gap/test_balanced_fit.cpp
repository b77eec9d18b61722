// Fits of a bench whose model is wrong by far more than its sensors' noise.
#include <gtest/gtest.h>

#include <cmath>

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

TEST_F(DriveWithAnErrorInItsTorque, LeavesResidualsInUnitsOfNoise) {
    const CauseFit fit = fitted(true);
    const CauseFitter fitter(bench_, {.segments = 12}, 1);
    const Hypothesis found = fit.hypothesis();
    EXPECT_TRUE(fitter.data_residuals({&found, 1})
                    .col(0)
                    .isApprox(fit.residuals.head(static_cast<Eigen::Index>(fitter.data_rows())), 1e-9));
}

}  // namespace
}  // namespace capstan::gap
