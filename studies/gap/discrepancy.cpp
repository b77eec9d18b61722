#include "capstan/gap/discrepancy.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "capstan/recording/channel_range.h"
#include "capstan/simple_models/stop_operator.h"

namespace capstan::gap {

namespace {

// E64. Above noise and floor the logarithm has the weight by which Evidence::overstated divides.
constexpr double above_noise_weight = 1.3;

constexpr double stop_widths[] = {0.02, 0.05, 0.1, 0.2, 0.4};  // of a channel's span

// Of the model's own error, as parts of the floor; the larger ones are errors of any kind.
constexpr std::array<double, 10> error_sizes = {smallest_floor, 0.7,  1.0, largest_floor, 2.0, 2.8, 5.6,
                                                11.0,           22.0, 45.0};
// Of the part of it that comes again when the motion does, in units of noise and floor.
constexpr double function_sizes[] = {0.0, 0.08, 0.16, 0.32};

double log_mean(const std::vector<double>& logs) {
    const double most = *std::max_element(logs.begin(), logs.end());
    double sum = 0.0;
    for (const double each : logs) sum += std::exp(each - most);
    return most + std::log(sum / static_cast<double>(logs.size()));
}

// A channel that drives some run, with what is needed to make it dimensionless.
struct Driving {
    std::size_t channel = 0;
    double middle = 0.0;
    double span = 1.0;
};

std::vector<Driving> driving_channels(const Recording& recording) {
    std::vector<Driving> all;
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        const std::string& name = recording.channels[channel].name;
        ValueRange driven{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
        for (const RecordedRun& run : recording.runs) {
            if (!run.drives(name)) continue;
            const ValueRange in_run = range_of(run.values[channel]);
            driven = {std::min(driven.low, in_run.low), std::max(driven.high, in_run.high)};
        }
        if (driven.high > driven.low) all.push_back({channel, driven.middle(), driven.span()});
    }
    constexpr std::size_t max_channels = 2;
    if (all.size() > max_channels) all.resize(max_channels);
    return all;
}

using Features = std::vector<std::vector<double>>;  // features x rows

Features features_of(const Recording& recording, const RecordedRun& run, const std::vector<Driving>& driving,
                     int stride) {
    const std::size_t rows =
        (run.time_s.size() + static_cast<std::size_t>(stride) - 1) / static_cast<std::size_t>(stride);
    const double step_s = stride / recording.sample_rate_Hz;
    Features signals;
    for (const Driving& each : driving) {
        std::vector<double> signal(rows, 0.0);
        if (run.drives(recording.channels[each.channel].name)) {
            for (std::size_t row = 0; row < rows; ++row)
                signal[row] =
                    (run.values[each.channel][row * static_cast<std::size_t>(stride)] - each.middle) /
                    each.span;
        }
        signals.push_back(signal);
    }
    Features features = {std::vector<double>(rows, 1.0)};
    const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
        std::vector<double> all(a.size());
        std::transform(a.begin(), a.end(), b.begin(), all.begin(), std::multiplies<>());
        return all;
    };
    for (std::size_t k = 0; k < signals.size(); ++k) {
        const std::vector<double>& signal = signals[k];
        features.push_back(signal);
        features.push_back(product(signal, signal));
        std::vector<double> speed(rows, 0.0);
        for (std::size_t row = 1; row < rows; ++row) speed[row] = (signal[row] - signal[row - 1]) / step_s;
        features.push_back(speed);
        for (const double width : stop_widths) {
            const Eigen::VectorXd bent = simple_models::stop_operator(signal, width);
            features.emplace_back(bent.begin(), bent.end());
            if (k == 0 && signals.size() > 1) features.push_back(product(features.back(), signals[1]));
        }
    }
    if (signals.size() > 1) features.push_back(product(signals[0], signals[1]));
    return features;
}

}  // namespace

double weighed_log(double misfit, double below_noise_weight) {
    constexpr double as_good_as_noise = 0.95;
    return (above_noise_weight - below_noise_weight) * std::log(std::max(misfit, as_good_as_noise)) +
           below_noise_weight * std::log(misfit);
}

double log_of_unknown_scale(double misfit) {
    return above_noise_weight * std::log(misfit);
}

Discrepancy::Discrepancy(const Recording& recording, const std::vector<ResidualSeries>& series, int stride,
                         double independent_samples)
    : series_(series) {
    const std::vector<Driving> driving = driving_channels(recording);
    std::vector<Features> features;
    for (const RecordedRun& run : recording.runs)
        features.push_back(features_of(recording, run, driving, stride));
    const std::size_t block_rows = rows_of_a_block(recording.sample_rate_Hz, stride);
    double all_determined = 0.0;
    for (const ResidualSeries& each : series_) all_determined += static_cast<double>(each.determined_rows());
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        Eigen::Index rows = 0;
        double determined = 0.0;
        for (const ResidualSeries& each : series_) {
            if (each.channel != channel) continue;
            rows += static_cast<Eigen::Index>(each.rows);
            determined += static_cast<double>(each.determined_rows());
        }
        if (rows == 0) continue;
        const auto count = static_cast<Eigen::Index>(features.front().size());
        Eigen::MatrixXd all(rows, count);
        Eigen::Index next = 0;
        for (const ResidualSeries& each : series_) {
            if (each.channel != channel) continue;
            for (Eigen::Index k = 0; k < count; ++k) {
                const std::vector<double>& feature = features[each.run][static_cast<std::size_t>(k)];
                for (std::size_t row = 0; row < each.rows; ++row)
                    all(next + static_cast<Eigen::Index>(row), k) =
                        each.determines(row) ? feature[static_cast<std::size_t>(each.first_sample) + row]
                                             : 0.0;
            }
            next += static_cast<Eigen::Index>(each.rows);
        }
        for (Eigen::Index k = 0; k < count; ++k) {
            const double mean_square = all.col(k).squaredNorm() / determined;
            if (mean_square > 0.0) all.col(k) /= std::sqrt(mean_square * static_cast<double>(count));
        }
        add_features(channels_, channel, all, determined, all_determined, independent_samples);
        ChannelBlocks own{blocks_of(series_, channel, block_rows), {}};
        Eigen::MatrixXd means(static_cast<Eigen::Index>(own.blocks.size()), count);
        for (Eigen::Index b = 0; b < means.rows(); ++b) {
            const ResidualBlock& block = own.blocks[static_cast<std::size_t>(b)];
            auto rows_of_block = all.middleRows(block.first_row_of_channel, block.rows);
            means.row(b) = rows_of_block.colwise().sum() / block.determined_rows;
            for (Eigen::Index row = 0; row < block.rows; ++row) {
                if (rows_of_block.row(row).any()) rows_of_block.row(row) -= means.row(b);
            }
        }
        for (const double size : error_sizes) own.models.push_back(block_model(own.blocks, means, size));
        blocks_.push_back(std::move(own));
        add_features(within_blocks_, channel, all, determined, all_determined, independent_samples);
    }
}

// The features of a channel as directions that are orthogonal.
void Discrepancy::add_features(std::vector<ChannelFeatures>& channels, std::size_t channel,
                               const Eigen::MatrixXd& features, double determined, double all_determined,
                               double independent_samples) const {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(features.transpose() * features / determined);
    std::vector<Eigen::Index> kept;
    constexpr double negligible = 1e-9;
    for (Eigen::Index k = 0; k < features.cols(); ++k) {
        if (parts.eigenvalues()[k] > negligible) kept.push_back(k);
    }
    ChannelFeatures of_channel;
    of_channel.channel = channel;
    of_channel.rows = determined;
    of_channel.part = determined / all_determined;
    of_channel.samples = independent_samples * of_channel.part;
    of_channel.variances = parts.eigenvalues()(kept);
    of_channel.directions = features * parts.eigenvectors()(Eigen::all, kept) *
                            of_channel.variances.cwiseSqrt().cwiseInverse().asDiagonal();
    channels.push_back(std::move(of_channel));
}

Discrepancy::BlockModel Discrepancy::block_model(const std::vector<ResidualBlock>& blocks,
                                                 const Eigen::MatrixXd& features, double error_size) {
    BlockModel model;
    model.precisions.resize(features.rows());
    for (Eigen::Index b = 0; b < features.rows(); ++b) {
        const ResidualBlock& block = blocks[static_cast<std::size_t>(b)];
        const double variance =
            error_size * error_size * (1.0 - block.noise_part) + block.noise_part / block.determined_rows;
        model.precisions[b] = block.counts() / variance;
        model.log_determinant += block.counts() * std::log(variance);
    }
    const Eigen::MatrixXd weighed = model.precisions.asDiagonal() * features;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(features.transpose() * weighed);
    model.gains = parts.eigenvalues().cwiseMax(0.0);
    model.projections = parts.eigenvectors().transpose() * weighed.transpose();
    return model;
}

// E69.
BlockLikelihoods Discrepancy::of_blocks(const Eigen::VectorXd& residuals) const {
    BlockLikelihoods all;
    std::vector<double> any_gains;  // of each channel, over an error of the model alone
    for (const ChannelBlocks& channel : blocks_) {
        Eigen::VectorXd means(static_cast<Eigen::Index>(channel.blocks.size()));
        for (Eigen::Index b = 0; b < means.size(); ++b) {
            const ResidualBlock& block = channel.blocks[static_cast<std::size_t>(b)];
            means[b] = block.mean_of(residuals);
        }
        std::array<std::vector<double>, discrepancy_sizes.size()> each;
        std::vector<double> any;
        for (std::size_t m = 0; m < channel.models.size(); ++m) {
            const BlockModel& model = channel.models[m];
            const double left = means.cwiseAbs2().dot(model.precisions) + model.log_determinant;
            const Eigen::ArrayXd along = (model.projections * means).array().square();
            any.push_back(-0.5 * left);
            if (error_sizes[m] > largest_floor) continue;
            for (std::size_t k = 0; k < discrepancy_sizes.size(); ++k) {
                for (const double of_model : function_sizes) {
                    const double variance = std::pow(discrepancy_sizes[k], 2) + of_model * of_model;
                    const Eigen::ArrayXd gained = variance * model.gains.array();
                    each[k].push_back(-0.5 * (left - (variance * along / (1.0 + gained)).sum() +
                                              (1.0 + gained).log().sum()));
                }
            }
        }
        for (std::size_t k = 0; k < discrepancy_sizes.size(); ++k) all.beside[k] += log_mean(each[k]);
        any_gains.push_back(log_mean(any) - log_mean(each.front()));
    }
    // What is outside the list acts on one channel, as a fault of its reading does, or on all of them, as a
    // friction does.
    any_gains.push_back(std::accumulate(any_gains.begin(), any_gains.end(), 0.0));
    all.beside_any = all.beside.front() + log_mean(any_gains);
    return all;
}

Marginals Discrepancy::within_blocks(const Eigen::VectorXd& residuals) const {
    Eigen::VectorXd deviations = residuals;
    for (const ChannelBlocks& channel : blocks_) {
        for (const ResidualBlock& block : channel.blocks) {
            auto rows = deviations.segment(block.first_row, block.rows);
            const double mean = block.mean_of(residuals);
            for (double& each : rows) each -= each == 0.0 ? 0.0 : mean;
        }
    }
    Marginals marginals;
    for (const ChannelFeatures& channel : within_blocks_) {
        const Marginals own = of_channel(channel, deviations);
        for (std::size_t k = 0; k < discrepancy_sizes.size(); ++k) {
            marginals[k].misfit += channel.part * own[k].misfit;
            marginals[k].log_determinant += own[k].log_determinant;
        }
    }
    return marginals;
}

Marginals Discrepancy::of_channel(const ChannelFeatures& channel, const Eigen::VectorXd& residuals) const {
    Eigen::VectorXd own(channel.directions.rows());
    Eigen::Index next = 0;
    for (const ResidualSeries& each : series_) {
        if (each.channel != channel.channel) continue;
        const auto rows = static_cast<Eigen::Index>(each.rows);
        own.segment(next, rows) = residuals.segment(static_cast<Eigen::Index>(each.first_row), rows);
        next += rows;
    }
    const double mean_square = own.squaredNorm() / channel.rows;
    const Eigen::ArrayXd along = (channel.directions.transpose() * own / channel.rows).array().square();
    Marginals marginals;
    for (std::size_t k = 0; k < discrepancy_sizes.size(); ++k) {
        // Samples of a direction add up; its prior variance is that of one sample.
        const Eigen::ArrayXd gained =
            channel.samples * std::pow(discrepancy_sizes[k], 2) * channel.variances.array();
        marginals[k] = {mean_square - (along * gained / (1.0 + gained)).sum(), (1.0 + gained).log().sum()};
    }
    return marginals;
}

Marginals Discrepancy::with_own_scales(const Eigen::VectorXd& residuals,
                                       const std::vector<double>& of_laws) const {
    double samples = 0.0;
    for (const ChannelFeatures& channel : channels_) samples += channel.samples;
    Marginals marginals;
    for (std::size_t c = 0; c < channels_.size(); ++c) {
        const Marginals own = of_channel(channels_[c], residuals);
        const double of_law = of_laws.empty() ? 0.0 : of_laws[c];
        for (std::size_t k = 0; k < discrepancy_sizes.size(); ++k) {
            marginals[k].misfit += channels_[c].samples / samples * std::log(own[k].misfit + of_law);
            marginals[k].log_determinant += own[k].log_determinant;
        }
    }
    for (Marginal& each : marginals) each.misfit = std::exp(each.misfit);
    return marginals;
}

void Discrepancy::set_samples(const std::function<double(std::size_t channel)>& samples_of) {
    for (ChannelFeatures& channel : channels_) channel.samples = samples_of(channel.channel);
}

}  // namespace capstan::gap
