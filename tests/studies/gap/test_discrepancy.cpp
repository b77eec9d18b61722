#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "capstan/gap/discrepancy.h"
#include "capstan/recording/channel_range.h"
#include "session_with_effects.h"

namespace capstan::gap {
namespace {

class OnASession : public testing::Test {
  protected:
    const Recording recording = exact_session({}, coarse_twin);
    const CauseFitter fitter{recording, coarse_twin, 1};
    const Discrepancy discrepancy{recording, fitter.series(), coarse_twin.stride,
                                  fitter.independent_samples()};

    Eigen::VectorXd residuals(
        const std::function<double(const ResidualSeries&, std::size_t row)>& value) const {
        Eigen::VectorXd all(static_cast<Eigen::Index>(fitter.data_rows()));
        for (const ResidualSeries& series : fitter.series()) {
            for (std::size_t row = 0; row < series.rows; ++row)
                all[static_cast<Eigen::Index>(series.first_row + row)] = value(series, row);
        }
        return all;
    }
};

// 8: as large as the sizes of an unknown cause.
constexpr std::size_t large = 6;

TEST_F(OnASession, NoDiscrepancyLeavesTheMeanSquareAndCostsNothing) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    const Eigen::VectorXd noise = residuals([&](const auto&, std::size_t) { return normal(random); });
    const Marginals beside = discrepancy.within_blocks(noise);
    const double mean_square = noise.squaredNorm() / static_cast<double>(noise.size());
    const auto rows = static_cast<double>(rows_of_a_block(recording.sample_rate_Hz, coarse_twin.stride));
    EXPECT_NEAR(beside[0].misfit, (1.0 - 1.0 / rows) * mean_square, 0.02) << "less the means of blocks";
    EXPECT_EQ(beside[0].log_determinant, 0.0);
}

TEST_F(OnASession, ALargerOneLeavesLessAndCostsMore) {
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    const Marginals beside =
        discrepancy.within_blocks(residuals([&](const auto&, std::size_t) { return normal(random); }));
    for (std::size_t k = 1; k < beside.size(); ++k) {
        EXPECT_LE(beside[k].misfit, beside[k - 1].misfit);
        EXPECT_GT(beside[k].log_determinant, beside[k - 1].log_determinant);
    }
}

TEST_F(OnASession, TakesInWhatIsAFunctionOfTheMotionButNotNoise) {
    const Marginals function =
        discrepancy.with_own_scales(residuals([&](const ResidualSeries& series, std::size_t row) {
            const RecordedRun& run = recording.runs[series.run];
            const auto driving = static_cast<std::size_t>(*recording.channel(run.driven.front()));
            const std::size_t sample =
                (static_cast<std::size_t>(series.first_sample) + row) * coarse_twin.stride;
            return 10.0 * run.values[driving][sample] - 3.0;
        }));
    EXPECT_LT(function[large].misfit, 0.05 * function[0].misfit);
    std::mt19937_64 random(3);
    std::normal_distribution<double> normal;
    const Marginals noise =
        discrepancy.within_blocks(residuals([&](const auto&, std::size_t) { return normal(random); }));
    EXPECT_GT(noise[large].misfit, 0.9 * noise[0].misfit);
}

// A channel whose error is a hundred times its noise does not drown the others.
TEST_F(OnASession, WithOwnScalesAChannelCountsByHowItsErrorChanges) {
    const std::size_t first = fitter.series().front().channel;
    const auto errors = [&](double of_first, double of_others) {
        std::mt19937_64 random(3);
        std::normal_distribution<double> normal;
        return discrepancy
            .with_own_scales(residuals([&](const ResidualSeries& series, std::size_t) {
                return (series.channel == first ? of_first : of_others) * normal(random);
            }))[0]
            .misfit;
    };
    const double before = errors(100.0, 3.0);
    double rows = 0.0;
    for (const ResidualSeries& series : fitter.series())
        rows += series.channel == first ? static_cast<double>(series.determined_rows()) : 0.0;
    const double part = rows / fitter.determined_rows();
    EXPECT_NEAR(errors(50.0, 3.0) / before, std::pow(0.25, part), 1e-9);
    EXPECT_NEAR(errors(100.0, 1.5) / before, std::pow(0.25, 1.0 - part), 1e-9);
    EXPECT_NEAR(errors(0.2, 0.2) / errors(0.1, 0.1), 4.0, 1e-9);
    EXPECT_NEAR(errors(3.0, 0.1) / errors(3.0, 0.2), std::pow(0.25, 1.0 - part), 1e-9);
}

// E60.
TEST_F(OnASession, WithOwnScalesAChannelCountsByItsSamplesAndByWhatItsLawsMayBeWrongBy) {
    const std::size_t first = fitter.series().front().channel;
    CauseFit nothing_left;
    nothing_left.residuals = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(fitter.data_rows()));
    const std::size_t channels = fitter.channel_misfits(nothing_left).size();
    const Eigen::VectorXd left = residuals([&](const ResidualSeries& series, std::size_t row) {
        return (series.channel == first ? 1e-6 : 1.0) * (row % 2 == 0 ? 1.0 : -1.0);
    });
    Discrepancy weighed = discrepancy;
    weighed.set_samples([&](std::size_t channel) { return channel == first ? 300.0 : 100.0; });
    std::vector<double> of_laws(channels, 0.0);
    of_laws.front() = 0.25;
    const double part = 300.0 / (300.0 + 100.0 * static_cast<double>(channels - 1));
    EXPECT_NEAR(weighed.with_own_scales(left, of_laws)[0].misfit, std::pow(0.25, part), 1e-3);
    EXPECT_LT(weighed.with_own_scales(left)[0].misfit, 1e-6);
}

// E69. Of the square of noise and floor this part is noise.
class InNoise : public OnASession {
  protected:
    static constexpr double noise_part = 0.9;
    const Discrepancy in_noise{recording, hidden_by_noise(), coarse_twin.stride,
                               fitter.independent_samples()};
    const std::size_t block_rows = rows_of_a_block(recording.sample_rate_Hz, coarse_twin.stride);
    const std::size_t first = fitter.series().front().channel;

    std::vector<ResidualSeries> hidden_by_noise() const {
        std::vector<ResidualSeries> series = fitter.series();
        for (ResidualSeries& each : series) each.noise_part = noise_part;
        return series;
    }
    // Noise, and an error that holds for a block and then has the other sign, in units of the floor.
    Eigen::VectorXd with_error(double of_first, double of_others) const {
        std::mt19937_64 random(3);
        std::normal_distribution<double> normal;
        return residuals([&](const ResidualSeries& series, std::size_t row) {
            const double sign = (row / block_rows) % 3 == 0 ? 1.0 : -1.0;
            const double error = sign * (series.channel == first ? of_first : of_others);
            return std::sqrt(noise_part) * normal(random) + std::sqrt(1.0 - noise_part) * error;
        });
    }
};

TEST_F(InNoise, TheMeansOfBlocksShowAnErrorThatTheMeanSquareHides) {
    const Eigen::VectorXd none = with_error(0.0, 0.0);
    const Eigen::VectorXd large_error = with_error(3.0, 0.0);
    const double of_all =
        0.5 * fitter.independent_samples() *
        std::log(in_noise.within_blocks(large_error)[0].misfit / in_noise.within_blocks(none)[0].misfit);
    const double of_blocks = in_noise.of_blocks(none).beside[0] - in_noise.of_blocks(large_error).beside[0];
    EXPECT_GT(of_blocks, 10.0 * of_all);
    EXPECT_GT(of_blocks, 30.0);
}

TEST_F(InNoise, TheFloorIsAnUpperValueOfTheModelsError) {
    const auto likelihood = [&](double error) {
        return in_noise.of_blocks(with_error(error, error)).beside[0];
    };
    const double blocks = static_cast<double>(fitter.data_rows()) / static_cast<double>(block_rows);
    EXPECT_LT(likelihood(0.0) - likelihood(0.5), 0.2 * blocks);
    EXPECT_LT(likelihood(0.5) - likelihood(1.0), likelihood(2.0) - likelihood(2.5));
}

// The model's own error lasts for half a second, of which a block is a half.
TEST(ResidualBlock, CountsAsIndependentAsNoiseMakesIt) {
    const auto counts = [](double noise_part, double rows) {
        return ResidualBlock{0, 0, 0, rows, noise_part}.counts();
    };
    EXPECT_EQ(counts(1.0, 50.0), 1.0);
    EXPECT_EQ(counts(0.0, 50.0), 0.5);
    EXPECT_NEAR(counts(0.5, 1.0), 0.75, 1e-12) << "one row: half of it is noise";
    EXPECT_LT(counts(0.5, 50.0), 0.52) << "noise averages out";
}

TEST_F(InNoise, AnErrorOfAnyKindIsMoreProbableThanALargeOneOfTheModel) {
    const BlockLikelihoods little = in_noise.of_blocks(with_error(0.7, 0.7));
    const BlockLikelihoods much = in_noise.of_blocks(with_error(20.0, 0.7));
    EXPECT_LT(little.beside_any, little.beside[0]);
    EXPECT_GT(much.beside_any, much.beside[0]);
}

// What the other channels show, an error of the model that is a function of the motion, does not say against
// an error of another kind in one channel.
TEST_F(InNoise, AnErrorOfOneChannelCostsTheChoiceOfTheChannel) {
    std::vector<ResidualSeries> of_first;
    std::vector<ResidualSeries> of_others;
    for (const ResidualSeries& each : hidden_by_noise())
        (each.channel == first ? of_first : of_others).push_back(each);
    const Eigen::VectorXd error = with_error(20.0, 0.0);
    const Eigen::VectorXd left = residuals([&](const ResidualSeries& series, std::size_t row) {
        const RecordedRun& run = recording.runs[series.run];
        const auto driving = static_cast<std::size_t>(*recording.channel(run.driven.front()));
        const std::size_t sample = static_cast<std::size_t>(series.first_sample) + row;
        const double of_motion = run.values[driving][sample] / (0.5 * range_of(recording, driving).span());
        return error[static_cast<Eigen::Index>(series.first_row + row)] +
               (series.channel == first ? 0.0 : of_motion);
    });
    const auto gained = [&](const std::vector<ResidualSeries>& series) {
        const Discrepancy of{recording, series, coarse_twin.stride, fitter.independent_samples()};
        const BlockLikelihoods blocks = of.of_blocks(left);
        return blocks.beside_any - blocks.beside[0];
    };
    EXPECT_LT(gained(of_others), -2.0);
    const double choices = 4.0;  // one of the three channels, or all of them
    EXPECT_NEAR(gained(hidden_by_noise()), gained(of_first), std::log(choices));
}

TEST_F(InNoise, ADeviationFromTheMeansOfBlocksHasNoMeans) {
    const Eigen::VectorXd steps = residuals([&](const ResidualSeries&, std::size_t row) {
        return 1.0 + static_cast<double>((row / block_rows) % 5);
    });
    EXPECT_LT(in_noise.within_blocks(steps)[0].misfit, 1e-20);
    const Eigen::VectorXd ripple =
        residuals([&](const ResidualSeries&, std::size_t row) { return row % 2 == 0 ? 1.0 : -1.0; });
    EXPECT_GT(in_noise.within_blocks(ripple)[0].misfit, 0.9);
}

}  // namespace
}  // namespace capstan::gap
