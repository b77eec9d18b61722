#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "capstan/gap/cause_fit.h"
#include "capstan/recording/recording.h"

namespace capstan::gap {

/// Standard deviations that a discrepancy may have, in units of noise and floor; the first is none.
inline constexpr std::array<double, 9> discrepancy_sizes = {0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0};

/// The logarithm of a mean square residual as the likelihood counts it (E64): below noise and floor with this
/// weight.
double weighed_log(double misfit, double below_noise_weight);
/// The same where the scale of a channel's error is not known: a smaller one says as much below noise as
/// above.
double log_of_unknown_scale(double misfit);

/// What residuals leave beside a discrepancy of each size.
struct Marginal {
    double misfit = 0.0;           ///< mean square, each part weighed as the discrepancy leaves it
    double log_determinant = 0.0;  ///< what the discrepancy's freedom costs, as in a Gaussian likelihood
};
using Marginals = std::array<Marginal, discrepancy_sizes.size()>;

/// What the means of residuals over blocks of a correlation time say (E69): their log-likelihoods beside a
/// discrepancy of each size, and beside an error of any kind and size in one channel or in all.
struct BlockLikelihoods {
    std::array<double, discrepancy_sizes.size()> beside{};
    double beside_any = 0.0;
};

/// A Gaussian process for what a model lacks: a function of what drives the bench, so that it comes again
/// when the motion does (M. Kennedy and A. O'Hagan, Bayesian calibration of computer models, J. R. Stat. Soc.
/// B 63, 2001). Each predicted channel has one. Its kernel is a sum over features of equal prior variance:
/// the driven channels, their squares, product and speeds, stop operators of five widths on each, and the
/// first one's stops times the second (E44, E45).
class Discrepancy {
  public:
    /// `series`: of the recording; `stride`: samples per row. `independent_samples`: of all rows together.
    Discrepancy(const Recording& recording, const std::vector<ResidualSeries>& series, int stride,
                double independent_samples);

    /// Where each channel's error has an unknown scale of its own: the misfit is the geometric mean over the
    /// channels, each in proportion to its samples (E54). `residuals`: all series one after the other, in
    /// units of noise and floor. `of_laws`: what the laws may be wrong by in each predicted channel, mean
    /// square, in the order of the channels; empty: nothing.
    Marginals with_own_scales(const Eigen::VectorXd& residuals,
                              const std::vector<double>& of_laws = {}) const;
    /// Noise averages out over a block, and the model's own error does not. The latter has a size of its own
    /// in each channel, about that of the floor, and a part of it may be a function of the motion.
    BlockLikelihoods of_blocks(const Eigen::VectorXd& residuals) const;
    /// Of the deviations from the means of blocks, by the same deviations of the features.
    Marginals within_blocks(const Eigen::VectorXd& residuals) const;
    /// Independent ones, of each channel by its index.
    void set_samples(const std::function<double(std::size_t channel)>& samples_of);

  private:
    struct ChannelFeatures {
        std::size_t channel = 0;
        double rows = 0.0;           // that count
        double samples = 0.0;        // independent ones
        double part = 0.0;           // of all rows that count
        Eigen::MatrixXd directions;  // rows of the channel x features: orthogonal, mean square of the rows 1
        Eigen::VectorXd variances;   // of each direction under a discrepancy of size 1
    };

    // The means of a channel's blocks beside noise and an error of one size.
    struct BlockModel {
        Eigen::VectorXd precisions;    // of each block
        double log_determinant = 0.0;  // of the variances
        Eigen::MatrixXd projections;   // directions of the features x blocks
        Eigen::VectorXd gains;         // of each direction, by a discrepancy of size 1
    };
    struct ChannelBlocks {
        std::vector<ResidualBlock> blocks;
        std::vector<BlockModel> models;  // by the size of the error
    };

    void add_features(std::vector<ChannelFeatures>& channels, std::size_t channel,
                      const Eigen::MatrixXd& features, double determined, double all_determined,
                      double independent_samples) const;
    static BlockModel block_model(const std::vector<ResidualBlock>& blocks, const Eigen::MatrixXd& features,
                                  double error_size);
    Marginals of_channel(const ChannelFeatures& channel, const Eigen::VectorXd& residuals) const;

    std::vector<ResidualSeries> series_;
    std::vector<ChannelFeatures> channels_;
    std::vector<ChannelFeatures> within_blocks_;  // the same of features without the means of blocks
    std::vector<ChannelBlocks> blocks_;
};

}  // namespace capstan::gap
