#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "capstan/calibration/least_squares.h"
#include "capstan/gap/effects_twin.h"
#include "capstan/gap/hypothesis.h"

namespace capstan::gap {

/// Residuals of one channel in one run.
struct ResidualSeries {
    std::size_t run = 0;
    std::size_t channel = 0;
    int first_sample = 0;       ///< of those predicted; before it lies the first loading from rest
    double scale = 1.0;         ///< noise and the model's floor together, in the channel's unit
    std::size_t first_row = 0;  // in a vector of all residuals
    std::size_t rows = 0;
    /// By row; empty: all. A driven angle that rests within a step of its encoder does not determine the
    /// friction, and residuals there count as zero.
    std::vector<bool> is_determined{};
    double noise_part = 0.0;  ///< of the square of `scale`

    bool determines(std::size_t row) const { return is_determined.empty() || is_determined[row]; }
    std::size_t determined_rows() const { return determined_rows(0, rows); }
    /// Of those from `from` to one before `to`.
    std::size_t determined_rows(std::size_t from, std::size_t to) const;
};

/// The correlation time of residuals, as long as nothing is known of them.
inline constexpr double usual_correlation_time_s = 0.25;

/// The model's own error is a function of where a drive is and of how it moves, which a hand leaves about as
/// they are for half a second.
inline constexpr double error_correlation_time_s = 0.5;

/// Rows of a series in the usual correlation time, at least one.
std::size_t rows_of_a_block(double sample_rate_Hz, int stride);

/// Neighbouring rows of one series, over which noise averages out (E69).
struct ResidualBlock {
    Eigen::Index first_row = 0;             // in a vector of all residuals
    Eigen::Index first_row_of_channel = 0;  // where the channel's series lie one after the other
    Eigen::Index rows = 0;
    double determined_rows = 0.0;
    double noise_part = 0.0;  ///< of the square of noise and floor

    /// As what part of an independent block it counts: noise is independent from block to block, and the
    /// model's own error is not.
    double counts() const {
        const double of_noise = noise_part / determined_rows;
        const double of_model = 1.0 - noise_part;
        return (of_noise + usual_correlation_time_s / error_correlation_time_s * of_model) /
               (of_noise + of_model);
    }
    double mean_of(const Eigen::VectorXd& residuals) const {
        return residuals.segment(first_row, rows).sum() / determined_rows;
    }
};

/// Those of a channel, of so many rows each; the last one of a series may have fewer. Without those that
/// determine nothing.
std::vector<ResidualBlock> blocks_of(const std::vector<ResidualSeries>& series, std::size_t channel,
                                     std::size_t rows);

/// Of the model's own error, as parts of the floor. The floor is an upper value, known to a factor of about
/// two.
inline constexpr double smallest_floor = 0.5;
inline constexpr double largest_floor = 1.4;

/// The series of every channel that the twin predicts, run by run.
std::vector<ResidualSeries> residual_series(const Recording& recording, const EffectsTwin& twin);

/// A part of a recording that is left out of a fit: from one fraction of a run's samples to another.
struct LeftOut {
    std::size_t run = 0;
    double from = 0.0;
    double to = 1.0;

    bool is_complete_run() const { return from == 0.0 && to == 1.0; }
    /// First and one past the last of this many.
    std::pair<std::size_t, std::size_t> rows(std::size_t count) const {
        return {static_cast<std::size_t>(from * static_cast<double>(count)),
                static_cast<std::size_t>(to * static_cast<double>(count))};
    }
};

/// The parts of `runs` runs to predict in turn from the rest: each run; the halves of each run where there is
/// one only, or where a cause is known from all runs together, as a number that follows a condition of the
/// runs or drifts from one to the next.
std::vector<LeftOut> left_out_in_turn(std::size_t runs, const std::vector<const CandidateCause*>& causes);

/// Of the residuals of each series in a search; empty: 1.
using SeriesWeights = std::vector<double>;

/// Those that undo the weights.
SeriesWeights inverse_of(SeriesWeights weights);

/// The best fit of one or several causes together.
struct CauseFit {
    std::vector<const CandidateCause*> causes;
    Eigen::VectorXd coordinates;  // the bench's floating numbers, then each cause's numbers
    Eigen::VectorXd residuals;    // all series one after the other without weights, then the priors
    SeriesWeights weights{};      // with which it was sought
    double sum_of_squares = 0.0;
    /// How much of what was probable of the numbers beforehand the recording leaves: the logarithm of the
    /// posterior's volume over the prior's (E57), at most 0.
    double log_volume_ratio = 0.0;
    /// Of the first three numbers of the bench, by the same method.
    Eigen::Matrix3d nominal_covariance = Eigen::Matrix3d::Zero();
    /// Variances of all numbers of the bench if no means of blocks were weighed (E69), so that they go with
    /// the mean square residual.
    Eigen::VectorXd bench_variances_without_blocks{};
    int evaluations = 0;
    bool converged = false;

    const BenchKnowledge* bench = &measured_bench();

    Hypothesis hypothesis() const { return {causes, coordinates, bench}; }
};

/// How the residuals of the data change with all coordinates of a hypothesis, over steps that are wide
/// enough to lead over the ripples that fronts make.
struct WideDerivatives {
    Eigen::VectorXd at;
    Eigen::VectorXd residuals;  // of the data, there, without weights
    Eigen::MatrixXd jacobian;   // rows of the data x coordinates, without weights
};

/// The rms change of the clearest channel when one cause or number alone is removed, in units of noise and
/// floor. A wrong nominal number is compared with the nominal bench; a cause that lets one go far by the
/// smaller of two changes, without and with that number.
struct Visibility {
    std::vector<double> of_causes;
    std::vector<double> of_the_bench;
};

/// Fits causes to a recording: the bench's numbers float within their uncertainty for every one of them.
class CauseFitter {
  public:
    /// `recording` must outlive it. `threads` as for parallel_for_each_index.
    CauseFitter(const Recording& recording, const EffectsTwinOptions& options, int threads);

    const std::vector<ResidualSeries>& series() const { return series_; }
    std::size_t data_rows() const { return data_rows_; }
    /// Of those rows the ones that count.
    double determined_rows() const { return determined_rows_; }

    struct FitOptions {
        std::optional<LeftOut> left_out;  ///< residuals there count as zero
        /// The size of the last cause is unknown: a scan over decades comes before the search.
        bool any_size = true;
        /// A search that will leave more than this, without weights, is given up.
        double pruned_sum_of_squares = std::numeric_limits<double>::infinity();
        SeriesWeights weights{};
        /// The weights follow what the fit leaves of each channel, where that is more than noise (E53).
        /// Otherwise a channel with little noise decides alone, although the model's error is larger, and the
        /// priors count for nothing.
        bool balanced = false;
        /// The start is where a fit with a coarser model ended: a search begins with small steps there.
        bool is_close = false;
    };
    CauseFit fit(const Hypothesis& start, const FitOptions& options) const;
    /// The same causes with the same weights, fitted without each part in turn, from the numbers of `all`.
    std::vector<CauseFit> fits_without(const CauseFit& all, std::span<const LeftOut> parts) const;
    /// A few rough steps of a search, everything free, with these weights, from the more promising of the
    /// starts: at least one. The sum of squares has weights. A start that has its first coordinates where
    /// derivatives are `known` begins with these.
    CauseFit rough_fit(std::span<const Hypothesis> starts, const SeriesWeights& weights,
                       const WideDerivatives& known = {}) const;
    /// The same from the best of several sizes of the last cause. Each is held while a few rough steps move
    /// the other numbers: where these have followed what the cause does, every size of it looks worse than
    /// none. Nothing if the cause has no size.
    std::optional<CauseFit> rough_fit_from_held_sizes(const Hypothesis& start,
                                                      const SeriesWeights& weights) const;
    /// Takes a simulation more than the hypothesis has coordinates.
    WideDerivatives wide_derivatives(const Hypothesis& at) const;
    /// Residuals of the data, a column a hypothesis.
    Eigen::MatrixXd data_residuals(std::span<const Hypothesis> hypotheses,
                                   std::optional<LeftOut> left_out = {}) const;
    /// Residuals and priors for one set of coordinates a column.
    Eigen::MatrixXd residuals(const Hypothesis& hypothesis, const Eigen::MatrixXd& coordinates,
                              std::optional<LeftOut> left_out = {}) const;
    /// To residuals of the data in the first rows, a column a hypothesis. Empty weights change nothing.
    void apply(const SeriesWeights& weights, Eigen::Ref<Eigen::MatrixXd> residuals) const;
    /// How visible each cause of a fit is, and each number of the bench that a measured bench does not have.
    Visibility visibility(const CauseFit& fit) const;
    /// Half the squared distance of the nominal numbers from their nominal values, in their uncertainties.
    double nominal_penalty(const CauseFit& fit) const;
    /// The same for the causes' own numbers and their usual values (a toe of a tenth of a newton or a bend of
    /// no length is unusual). Sizes have so wide a prior that they add almost nothing.
    double shape_penalty(const CauseFit& fit) const;
    /// Mean square of the residuals of the data.
    double misfit(const CauseFit& fit) const;
    /// The same of each predicted channel.
    std::vector<double> channel_misfits(const CauseFit& fit) const;
    /// The mean square of the model's floor in each predicted channel, in units of noise and floor.
    std::vector<double> channel_floors() const;
    /// Half widths of 95% intervals of the coordinates of a fit, the widest of three: the sandwich over
    /// blocks of a second of all channels, what the independent samples and the priors leave open, and the
    /// jackknife over `without_a_run`, if there are at least three.
    Eigen::VectorXd half_widths(const CauseFit& fit, const std::vector<Eigen::VectorXd>& without_a_run) const;
    /// The distance of each coordinate from its usual value, weighted as a residual. A size has no usual
    /// value; its prior only keeps a search from running away.
    Eigen::VectorXd prior_residuals(const Hypothesis& hypothesis, const Eigen::VectorXd& coordinates) const;

    const EffectsTwin& twin() const { return twin_; }
    /// The number of independent instants in the recording: neighbouring residuals are correlated.
    double independent_samples() const;
    /// The part of them that a channel has.
    double independent_samples(std::size_t channel) const;
    /// For how long neighbouring residuals of each channel, by its index, are correlated (E60), between what
    /// motion allows and what is assumed as long as nothing is known of them.
    std::map<std::size_t, double> correlation_times_s(const Eigen::VectorXd& residuals) const;
    /// Independent samples, and balanced weights of the channels, follow these from now on.
    void set_correlation_times(std::map<std::size_t, double> times_s);
    /// From now on balanced weights are those of the likelihood of blocks (E69).
    void weigh_blocks() { weighs_blocks_ = true; }
    /// By how much evidence the one sum of squares with weights and priors is behind the other.
    double behind(double sum_of_squares, double other) const;

  private:
    void write_residuals(std::size_t run, const TwinRun& twin,
                         const std::map<std::string, SensorFaults>& faults,
                         Eigen::Ref<Eigen::VectorXd> all) const;
    /// Of each channel, by its index.
    std::map<std::size_t, double> mean_squares(const Eigen::VectorXd& residuals) const;
    double clearest_change(const Eigen::VectorXd& change) const;
    SeriesWeights balancing_weights(const Eigen::VectorXd& residuals) const;
    SeriesWeights block_weights(const Eigen::VectorXd& residuals) const;
    /// Mean squares of the means of blocks of each channel, by its index.
    std::map<std::size_t, double> block_mean_squares(const Eigen::VectorXd& residuals) const;
    /// Fills in what follows from the residuals and their Jacobian.
    void integrate(CauseFit& fit, const Eigen::MatrixXd& jacobian) const;
    /// The rows of a part.
    void set_zero(const LeftOut& part, Eigen::Ref<Eigen::MatrixXd> residuals) const;
    LeastSquaresOptions search_from(const Hypothesis& start) const;
    /// Residuals and priors of the causes of `hypothesis` with these weights.
    ResidualFunction weighted(const Hypothesis& hypothesis, const SeriesWeights& weights,
                              std::optional<LeftOut> left_out) const;
    CauseFit fit_over_ripples(const Hypothesis& start, const FitOptions& options) const;
    /// A search that begins with the derivatives of all numbers but the last cause's.
    LeastSquaresFit beside_known(const Hypothesis& start, const SeriesWeights& weights,
                                 const WideDerivatives& known) const;
    CauseFit fit_with(const SeriesWeights& weights, const Hypothesis& start, const FitOptions& options,
                      int iterations, double difference_step) const;
    CauseFit completed(const Hypothesis& hypothesis, const SeriesWeights& weights,
                       const LeastSquaresFit& found) const;
    Eigen::VectorXd roughly_sized(const Hypothesis& start, const FitOptions& options,
                                  const SeriesWeights& weights, int& evaluations) const;

    const Recording& recording_;
    EffectsTwin twin_;
    int threads_;
    std::vector<ResidualSeries> series_;
    std::vector<std::optional<double>> lattice_;  // channels: unstated steps on which all their values lie
    std::size_t data_rows_ = 0;
    double determined_rows_ = 0.0;
    double prior_weight_ = 1.0;
    bool weighs_blocks_ = false;
    double duration_s_ = 0.0;             // of all runs
    std::map<std::size_t, double> rows_;  // that count, of each channel
    std::map<std::size_t, double> correlation_time_s_;
};

}  // namespace capstan::gap
