// What a fit shows: what it leaves, how clear each cause is, how unusual and how certain its numbers are.

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "capstan/gap/cause_fit.h"
#include "capstan/platform/statistics.h"
#include "capstan/recording/block_bootstrap.h"

namespace capstan::gap {

namespace {

// Each nominal number gets the widest prior of all causes.
double prior_std_of_bench(const Hypothesis& hypothesis, Eigen::Index number) {
    double spread = hypothesis.bench->numbers[static_cast<std::size_t>(number)].prior_std;
    for (const CandidateCause* cause : hypothesis.causes)
        spread = std::max(spread, cause->nominal_std(number));
    return spread;
}

}  // namespace

Eigen::VectorXd CauseFitter::prior_residuals(const Hypothesis& hypothesis,
                                             const Eigen::VectorXd& coordinates) const {
    Eigen::VectorXd priors(coordinates.size());
    Eigen::Index row = 0;
    for (; row < hypothesis.bench->size(); ++row)
        priors[row] = prior_weight_ * coordinates[row] / prior_std_of_bench(hypothesis, row);
    for (const CandidateCause* cause : hypothesis.causes) {
        for (const OpenNumber& number : cause->numbers) {
            priors[row] = prior_weight_ * (coordinates[row] - number.prior_mean()) / number.prior_std();
            ++row;
        }
    }
    return priors;
}

// E57. The Jacobian is that of the last step, with the weights of the search.
void CauseFitter::integrate(CauseFit& fit, const Eigen::MatrixXd& jacobian) const {
    const auto data_rows = static_cast<Eigen::Index>(data_rows_);
    Eigen::VectorXd widths(fit.coordinates.size());
    Eigen::Index row = 0;
    for (; row < fit.bench->size(); ++row) widths[row] = prior_std_of_bench(fit.hypothesis(), row);
    double log_ratio = 0.0;
    for (const CandidateCause* cause : fit.causes) {
        for (const OpenNumber& number : cause->numbers) {
            log_ratio -= number.log_choices();
            widths[row] = number.prior_width(fit.coordinates[row]);
            ++row;
        }
    }
    Eigen::MatrixXd told = jacobian.topRows(data_rows) * widths.asDiagonal();
    const Eigen::Index count = widths.size();
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(count, count);
    const auto factor_of = [&](double scale) {
        const Eigen::MatrixXd information = told.transpose() * told / (prior_weight_ * prior_weight_ * scale);
        return Eigen::LLT<Eigen::MatrixXd>(identity + information);
    };
    const auto covariance_of = [&](const Eigen::LLT<Eigen::MatrixXd>& factor) -> Eigen::MatrixXd {
        return widths.asDiagonal() * factor.solve(identity) * widths.asDiagonal();
    };
    // Where blocks are weighed, what counts beside them is residuals as they are.
    Eigen::VectorXd left = fit.residuals;
    if (weighs_blocks_) {
        apply(inverse_of(fit.weights), told);
    } else {
        apply(fit.weights, left);
    }
    constexpr double as_good_as_noise = 1.0;  // less than noise and floor determines no number better
    const double scale = std::max(as_good_as_noise, left.head(data_rows).squaredNorm() / determined_rows_);
    Eigen::LLT<Eigen::MatrixXd> factor = factor_of(scale);
    fit.bench_variances_without_blocks = covariance_of(factor).diagonal().head(fit.bench->size());
    if (weighs_blocks_) {
        apply(block_weights(fit.residuals), told);
        factor = factor_of(1.0);
    }
    fit.log_volume_ratio = log_ratio - factor.matrixLLT().diagonal().array().log().sum();
    fit.nominal_covariance = covariance_of(factor).topLeftCorner<nominal_coordinates, nominal_coordinates>();
}

Visibility CauseFitter::visibility(const CauseFit& fit) const {
    std::vector<Hypothesis> hypotheses = {fit.hypothesis()};
    for (const CandidateCause* cause : fit.causes) {
        Hypothesis without =
            only_causes(fit.hypothesis(), [&](const CandidateCause& other) { return &other != cause; });
        // A cause may let a nominal number go far. It is there only as far as its own numbers show, too: with
        // a size of nothing it is the wrong nominal number alone.
        const Hypothesis with_far_number = without;
        for (Eigen::Index number = 0; number < nominal_coordinates; ++number) {
            if (cause->nominal_std(number) > fit.bench->numbers[static_cast<std::size_t>(number)].prior_std)
                without.coordinates[number] = 0.0;
        }
        hypotheses.push_back(cause->numbers.empty() ? without : with_far_number);
        hypotheses.push_back(without);
    }
    const Eigen::Index numbers = fit.bench->size() > nominal_coordinates ? fit.bench->size() : 0;
    for (Eigen::Index number = 0; number < numbers; ++number) {
        hypotheses.push_back(fit.hypothesis());
        hypotheses.back().coordinates[number] = 0.0;
    }
    const Eigen::MatrixXd residuals = data_residuals(hypotheses);
    Visibility visibility;
    const auto change = [&](Eigen::Index column) {
        return clearest_change(residuals.col(column) - residuals.col(0));
    };
    Eigen::Index next = 1;
    for (; visibility.of_causes.size() < fit.causes.size(); next += 2)
        visibility.of_causes.push_back(std::min(change(next), change(next + 1)));
    for (; next < residuals.cols(); ++next) visibility.of_the_bench.push_back(change(next));
    return visibility;
}

std::map<std::size_t, double> CauseFitter::mean_squares(const Eigen::VectorXd& residuals) const {
    std::map<std::size_t, double> squares;
    std::map<std::size_t, double> rows;
    for (const ResidualSeries& series : series_) {
        squares[series.channel] +=
            residuals
                .segment(static_cast<Eigen::Index>(series.first_row), static_cast<Eigen::Index>(series.rows))
                .squaredNorm();
        rows[series.channel] += static_cast<double>(series.determined_rows());
    }
    for (auto& [channel, mean_square] : squares) mean_square /= std::max(1.0, rows[channel]);
    return squares;
}

// E60. The correlation that is measured, up to the lag where nothing is left of it, holds for the part of the
// residuals that noise explains. The rest is the error of the model, and as correlated as is usual.
std::map<std::size_t, double> CauseFitter::correlation_times_s(const Eigen::VectorXd& residuals) const {
    // What a model lacks follows the motion, and a hand changes its motion within a tenth of a second.
    constexpr double shortest_s = 0.1;
    constexpr double gone = 0.05;
    const double step_s = twin_.stride() / recording_.sample_rate_Hz;
    std::map<std::size_t, double> times_s;
    for (const auto& [channel, mean_square] : mean_squares(residuals)) {
        const auto sum_over_series = [&, of = channel](const auto& value) {
            double sum = 0.0;
            for (const ResidualSeries& series : series_) {
                if (series.channel == of) sum += value(series);
            }
            return sum;
        };
        const double squares = mean_square * rows_.at(channel);
        double time_s = step_s;
        for (Eigen::Index lag = 1; time_s < usual_correlation_time_s; ++lag) {
            const double products = sum_over_series([&](const ResidualSeries& series) {
                if (series.rows <= static_cast<std::size_t>(lag)) return 0.0;
                const auto own = residuals.segment(static_cast<Eigen::Index>(series.first_row),
                                                   static_cast<Eigen::Index>(series.rows));
                return own.head(own.size() - lag).dot(own.tail(own.size() - lag));
            });
            if (products <= gone * squares) break;
            time_s += 2.0 * step_s * products / squares;
        }
        time_s = std::clamp(time_s, shortest_s, usual_correlation_time_s);
        const double noise = sum_over_series([&](const ResidualSeries& series) {
            return series.noise_part * static_cast<double>(series.determined_rows());
        });
        const double part = squares > noise ? noise / squares : 1.0;
        times_s[channel] = 1.0 / (part / time_s + (1.0 - part) / usual_correlation_time_s);
    }
    return times_s;
}

double CauseFitter::clearest_change(const Eigen::VectorXd& change) const {
    double clearest = 0.0;
    for (const auto& [channel, mean_square] : mean_squares(change))
        clearest = std::max(clearest, std::sqrt(mean_square));
    return clearest;
}

double CauseFitter::misfit(const CauseFit& fit) const {
    return fit.residuals.head(static_cast<Eigen::Index>(data_rows_)).squaredNorm() / determined_rows_;
}

std::vector<double> CauseFitter::channel_misfits(const CauseFit& fit) const {
    std::vector<double> misfits;
    for (const auto& [channel, mean_square] : mean_squares(fit.residuals)) misfits.push_back(mean_square);
    return misfits;
}

std::vector<double> CauseFitter::channel_floors() const {
    std::map<std::size_t, double> sums;
    for (const ResidualSeries& series : series_)
        sums[series.channel] += (1.0 - series.noise_part) * static_cast<double>(series.determined_rows());
    std::vector<double> floors;
    for (const auto& [channel, sum] : sums) floors.push_back(sum / std::max(1.0, rows_.at(channel)));
    return floors;
}

double CauseFitter::nominal_penalty(const CauseFit& fit) const {
    return 0.5 * prior_residuals(fit.hypothesis(), fit.coordinates).head(fit.bench->size()).squaredNorm() /
           (prior_weight_ * prior_weight_);
}

double CauseFitter::shape_penalty(const CauseFit& fit) const {
    const Eigen::VectorXd priors = prior_residuals(fit.hypothesis(), fit.coordinates);
    return 0.5 * priors.tail(priors.size() - fit.bench->size()).squaredNorm() /
           (prior_weight_ * prior_weight_);
}

Eigen::VectorXd CauseFitter::half_widths(const CauseFit& fit,
                                         const std::vector<Eigen::VectorXd>& without_a_run) const {
    Eigen::VectorXd here = fit.residuals;
    apply(fit.weights, here);
    const Eigen::MatrixXd jacobian = jacobian_at(
        [&](const Eigen::MatrixXd& coordinates) {
            Eigen::MatrixXd all = residuals(fit.hypothesis(), coordinates);
            apply(fit.weights, all);
            return all;
        },
        fit.coordinates, here);
    // Channels of one instant are correlated, so a block has the rows of all of them.
    std::map<std::pair<std::size_t, std::size_t>, std::vector<Eigen::Index>> blocks;  // run, second: rows
    for (const ResidualSeries& series : series_) {
        for (std::size_t row = 0; row < series.rows; ++row) {
            const auto sample = (static_cast<std::size_t>(series.first_sample) + row) *
                                static_cast<std::size_t>(twin_.stride());
            const auto second = sample / static_cast<std::size_t>(bootstrap_block_samples(recording_));
            blocks[{series.run, second}].push_back(static_cast<Eigen::Index>(series.first_row + row));
        }
    }
    std::vector<Eigen::Index> order;
    std::vector<Eigen::Index> ends;
    for (const auto& [block, rows] : blocks) {
        order.insert(order.end(), rows.begin(), rows.end());
        ends.push_back(static_cast<Eigen::Index>(order.size()));
    }
    for (auto row = static_cast<Eigen::Index>(data_rows_); row < jacobian.rows(); ++row) order.push_back(row);
    const Sandwich sandwich = sandwich_of(jacobian(order, Eigen::all), here(order), ends);
    const Eigen::VectorXd independent = prior_weight_ * prior_weight_ * sandwich.inverse.diagonal();
    const Eigen::VectorXd deviations = sandwich.covariance.diagonal().cwiseMax(independent).cwiseSqrt();
    return (two_sided_95 * deviations).cwiseMax(jackknife_half_widths(without_a_run, deviations.size()));
}

}  // namespace capstan::gap
