#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "capstan/gap/effects_twin.h"
#include "capstan/gap/hypothesis.h"
#include "capstan/gap/least_squares.h"

namespace capstan::gap {

/// Residuals of one channel in one run.
struct ResidualSeries {
    std::size_t run = 0;
    std::size_t channel = 0;
    int first_sample = 0;       ///< of those predicted; before it lies the first loading from rest
    double scale = 1.0;         ///< noise and the model's floor together, in the channel's unit
    std::size_t first_row = 0;  // in a vector of all residuals
    std::size_t rows = 0;
};

/// Of every channel that the twin predicts, run by run.
std::vector<ResidualSeries> residual_series(const Recording& recording, const EffectsTwin& twin);

/// Part of a recording that a fit does not see: of a run, from one fraction of its samples to another.
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

/// The best that one or several causes together can do.
struct CauseFit {
    std::vector<const CandidateCause*> causes;
    Eigen::VectorXd coordinates;  // friction, stiffness, pretension logarithms, then each cause's numbers
    Eigen::VectorXd residuals;    // all series one after the other, then the priors
    double sum_of_squares = 0.0;
    int evaluations = 0;
    bool converged = false;

    Hypothesis hypothesis() const { return {causes, coordinates}; }
};

/// Fits causes to a recording: nominal numbers float within their uncertainty for every one of them.
class CauseFitter {
  public:
    /// `recording` must outlive it. `threads` as for parallel_for_each_index.
    CauseFitter(const Recording& recording, const EffectsTwinOptions& options, int threads);

    const std::vector<ResidualSeries>& series() const { return series_; }
    std::size_t data_rows() const { return data_rows_; }

    struct FitOptions {
        std::optional<LeftOut> left_out;  ///< residuals there count as zero
        /// The last cause's sizes are unknown: looked for over decades before the search.
        bool any_size = true;
        double pruned_sum_of_squares = std::numeric_limits<double>::infinity();
    };
    CauseFit fit(const Hypothesis& start, const FitOptions& options) const;
    /// Residuals of the data, a column a hypothesis.
    Eigen::MatrixXd data_residuals(std::span<const Hypothesis> hypotheses,
                                   std::optional<LeftOut> left_out = {}) const;
    /// Residuals and priors for one set of coordinates a column.
    Eigen::MatrixXd residuals(const std::vector<const CandidateCause*>& causes,
                              const Eigen::MatrixXd& coordinates, std::optional<LeftOut> left_out = {}) const;
    /// What each cause of a fit does to the clearest channel: rms of the change when it alone is left out,
    /// in units of noise and floor; of a wrong nominal number, against the nominal bench.
    std::vector<std::vector<double>> visibility(std::span<const CauseFit> fits) const;
    /// How far the nominal numbers had to go: half the sum of squares in units of their uncertainty.
    double nominal_penalty(const CauseFit& fit) const;
    /// The same of how far the causes' own numbers are from what is usual: a toe of a tenth of a newton, a
    /// bend of no length. Sizes cost next to nothing.
    double shape_penalty(const CauseFit& fit) const;
    /// Mean square of the residuals of the data.
    double misfit(const CauseFit& fit) const;
    /// Of the coordinates alone.
    Eigen::VectorXd prior_residuals(const std::vector<const CandidateCause*>& causes,
                                    const Eigen::VectorXd& coordinates) const;

    const EffectsTwin& twin() const { return twin_; }
    /// Independent instants in the recording: residuals of one instant hang together with those of the next.
    double independent_samples() const;

  private:
    void write_residuals(std::size_t run, const TwinRun& twin,
                         const std::map<std::string, SensorFaults>& faults,
                         Eigen::Ref<Eigen::VectorXd> all) const;
    double clearest_change(const Eigen::VectorXd& change) const;
    Eigen::VectorXd roughly_sized(const Hypothesis& start, const FitOptions& options, int& evaluations) const;

    const Recording& recording_;
    EffectsTwin twin_;
    int threads_;
    std::vector<ResidualSeries> series_;
    std::vector<std::optional<double>> lattice_;  // channels: unstated steps on which all their values lie
    std::size_t data_rows_ = 0;
    double prior_weight_ = 1.0;
};

}  // namespace capstan::gap
