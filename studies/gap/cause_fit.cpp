#include "capstan/gap/cause_fit.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <optional>

#include "capstan/platform/parallel_for.h"
#include "capstan/recording/channel_range.h"

namespace capstan::gap {

namespace {

// Trials of a search after each Jacobian, which move side by side.
constexpr int dampings_at_once = 4;
constexpr int max_iterations = 20;
// Steps of derivatives. A wide one leads over the ripples that fronts make, towards the right minimum.
constexpr double fine_step = 0.01;
constexpr double rough_step = 0.1;
constexpr int rough_iterations = 5;
constexpr double not_converged = 1.5;  // a rough search may still come down by this factor
// A search ends where a further step promises to change the evidence by less than this.
constexpr double min_gain = 0.02;

// A size below nothing changes nothing, and a search that left it there could not come back.
Eigen::VectorXd lower_bounds_of(const Hypothesis& hypothesis) {
    const double none = -std::numeric_limits<double>::infinity();
    Eigen::VectorXd bounds = Eigen::VectorXd::Constant(hypothesis.coordinates.size(), none);
    Eigen::Index next = 0;
    for (const FloatingNumber& number : hypothesis.bench->numbers) {
        if (number.kind == FloatingNumber::Kind::size) bounds[next] = 0.0;
        ++next;
    }
    for (const CandidateCause* cause : hypothesis.causes) {
        for (const OpenNumber& number : cause->numbers) {
            if (number.kind == OpenNumber::Kind::size) bounds[next] = 0.0;
            ++next;
        }
    }
    return bounds;
}

}  // namespace

CauseFitter::CauseFitter(const Recording& recording, const EffectsTwinOptions& options, int threads)
    : recording_(recording), twin_(recording, options), threads_(threads) {
    series_ = residual_series(recording, twin_);
    for (const ResidualSeries& series : series_) {
        data_rows_ += series.rows;
        determined_rows_ += static_cast<double>(series.determined_rows());
        rows_[series.channel] += static_cast<double>(series.determined_rows());
    }
    for (const RecordedRun& run : recording.runs) duration_s_ += run.time_s.back() - run.time_s.front();
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel)
        lattice_.push_back(unstated_step(recording, channel));
    std::map<std::size_t, double> times_s;
    for (const auto& [channel, rows] : rows_) times_s[channel] = usual_correlation_time_s;
    set_correlation_times(std::move(times_s));
}

void CauseFitter::set_correlation_times(std::map<std::size_t, double> times_s) {
    correlation_time_s_ = std::move(times_s);
    // Priors weigh against independent samples, not against all of them.
    prior_weight_ = std::sqrt(determined_rows_ / independent_samples());
}

double CauseFitter::independent_samples(std::size_t channel) const {
    return rows_.at(channel) / determined_rows_ * duration_s_ / correlation_time_s_.at(channel);
}

double CauseFitter::independent_samples() const {
    double samples = 0.0;
    for (const auto& [channel, time_s] : correlation_time_s_) samples += independent_samples(channel);
    return samples;
}

// A rounded reading determines the value only to half a step. A smaller residual counts as zero.
void CauseFitter::write_residuals(std::size_t run, const TwinRun& twin,
                                  const std::map<std::string, SensorFaults>& faults,
                                  Eigen::Ref<Eigen::VectorXd> all) const {
    for (const ResidualSeries& series : series_) {
        if (series.run != run) continue;
        const std::vector<double>& measured = recording_.runs[run].values[series.channel];
        const std::vector<double>& predicted = twin.values[series.channel];
        const auto faulty = faults.find(recording_.channels[series.channel].name);
        const bool coarse = lattice_[series.channel] && faulty != faults.end() && faulty->second.step > 0.0;
        const double reach = coarse ? 0.5 * *lattice_[series.channel] : 0.0;
        for (std::size_t row = 0; row < series.rows; ++row) {
            if (!series.determines(row)) {
                all[static_cast<Eigen::Index>(series.first_row + row)] = 0.0;
                continue;
            }
            const std::size_t sample = static_cast<std::size_t>(series.first_sample) + row;
            const double off =
                measured[sample * static_cast<std::size_t>(twin_.stride())] - predicted[sample];
            all[static_cast<Eigen::Index>(series.first_row + row)] =
                std::copysign(std::max(0.0, std::abs(off) - reach), off) / series.scale;
        }
    }
}

Eigen::MatrixXd CauseFitter::data_residuals(std::span<const Hypothesis> hypotheses,
                                            std::optional<LeftOut> left_out) const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(data_rows_),
                                                static_cast<Eigen::Index>(hypotheses.size()));
    std::vector<SameBench> benches;
    for (std::size_t run = 0; run < recording_.runs.size(); ++run) {
        if (left_out && left_out->run == run && left_out->is_complete_run()) continue;
        std::vector<SameBench> of_run = by_bench(hypotheses, recording_, run);
        std::move(of_run.begin(), of_run.end(), std::back_inserter(benches));
    }
    const std::vector<BenchGroup> groups = to_be_moved_at_once(std::move(benches), recording_);
    parallel_for_each_index(static_cast<int>(groups.size()), threads_, [&](int task) {
        const BenchGroup& group = groups[static_cast<std::size_t>(task)];
        std::vector<MovedBench> moved;
        for (const SameBench& bench : group) moved.push_back(bench.moved);
        const std::vector<TwinRun> twins = twin_.run_each(moved);
        for (std::size_t lane = 0; lane < twins.size(); ++lane) {
            const std::size_t run = moved[lane].run;
            for (const std::size_t k : group[lane].hypotheses) {
                const auto faults = bench_numbers(hypotheses[k]).in_run(recording_.runs[run]).sensor_faults;
                auto smooth = faults;
                for (auto& [channel, fault] : smooth) {
                    if (lattice_[static_cast<std::size_t>(*recording_.channel(channel))]) fault.step = 0.0;
                }
                write_residuals(run,
                                faults.empty() ? twins[lane] : twin_.with_faults(run, twins[lane], smooth),
                                faults, all.col(static_cast<Eigen::Index>(k)));
            }
        }
    });
    if (left_out) set_zero(*left_out, all);
    return all;
}

void CauseFitter::set_zero(const LeftOut& part, Eigen::Ref<Eigen::MatrixXd> residuals) const {
    for (const ResidualSeries& series : series_) {
        if (part.run != series.run) continue;
        const auto [from, to] = part.rows(series.rows);
        residuals
            .middleRows(static_cast<Eigen::Index>(series.first_row + from),
                        static_cast<Eigen::Index>(to - from))
            .setZero();
    }
}

Eigen::MatrixXd CauseFitter::residuals(const Hypothesis& hypothesis, const Eigen::MatrixXd& coordinates,
                                       std::optional<LeftOut> left_out) const {
    std::vector<Hypothesis> hypotheses;
    for (Eigen::Index column = 0; column < coordinates.cols(); ++column)
        hypotheses.push_back({hypothesis.causes, coordinates.col(column), hypothesis.bench});
    Eigen::MatrixXd all(static_cast<Eigen::Index>(data_rows_) + coordinates.rows(), coordinates.cols());
    all.topRows(static_cast<Eigen::Index>(data_rows_)) = data_residuals(hypotheses, left_out);
    for (Eigen::Index column = 0; column < coordinates.cols(); ++column)
        all.col(column).tail(coordinates.rows()) = prior_residuals(hypothesis, coordinates.col(column));
    return all;
}

// E53. Where the scale of a channel's error is not known, less than noise and floor is one, too (E54).
SeriesWeights CauseFitter::balancing_weights(const Eigen::VectorXd& residuals) const {
    if (weighs_blocks_) return block_weights(residuals);
    const double least = recording_.nominal_is_fitted ? 1e-6 : 1.0;
    const std::map<std::size_t, double> left = mean_squares(residuals);
    SeriesWeights weights;
    for (const ResidualSeries& series : series_) {
        const double samples_of_a_row =  // relative to the average row
            duration_s_ / (correlation_time_s_.at(series.channel) * independent_samples());
        weights.push_back(std::sqrt(samples_of_a_row / std::max(least, left.at(series.channel))));
    }
    return weights;
}

std::map<std::size_t, double> CauseFitter::block_mean_squares(const Eigen::VectorXd& residuals) const {
    const std::size_t rows = rows_of_a_block(recording_.sample_rate_Hz, twin_.stride());
    std::map<std::size_t, double> mean_squares;
    for (const auto& [channel, its_rows] : rows_) {
        const std::vector<ResidualBlock> blocks = blocks_of(series_, channel, rows);
        double squares = 0.0;
        for (const ResidualBlock& block : blocks) squares += std::pow(block.mean_of(residuals), 2);
        mean_squares[channel] = squares / std::max(1.0, static_cast<double>(blocks.size()));
    }
    return mean_squares;
}

// E69. A row counts as the part of its block that it is.
SeriesWeights CauseFitter::block_weights(const Eigen::VectorXd& residuals) const {
    const auto rows = static_cast<double>(rows_of_a_block(recording_.sample_rate_Hz, twin_.stride()));
    const std::map<std::size_t, double> left = block_mean_squares(residuals);
    SeriesWeights weights;
    for (const ResidualSeries& series : series_) {
        const double least =
            smallest_floor * smallest_floor * (1.0 - series.noise_part) + series.noise_part / rows;
        const double counts = ResidualBlock{0, 0, 0, rows, series.noise_part}.counts();
        weights.push_back(prior_weight_ *
                          std::sqrt(counts / (rows * std::max(least, left.at(series.channel)))));
    }
    return weights;
}

double CauseFitter::behind(double sum_of_squares, double other) const {
    if (weighs_blocks_) return 0.5 * (sum_of_squares - other) / (prior_weight_ * prior_weight_);
    return 0.5 * independent_samples() * std::log(sum_of_squares / other);
}

SeriesWeights inverse_of(SeriesWeights weights) {
    for (double& weight : weights) weight = 1.0 / weight;
    return weights;
}

void CauseFitter::apply(const SeriesWeights& weights, Eigen::Ref<Eigen::MatrixXd> residuals) const {
    for (std::size_t k = 0; k < weights.size(); ++k)
        residuals.middleRows(static_cast<Eigen::Index>(series_[k].first_row),
                             static_cast<Eigen::Index>(series_[k].rows)) *= weights[k];
}

// The nominal numbers can explain much of what a cause does, and a search that moves them first can stop in
// that local minimum. Therefore a coarse scan sizes the last cause with everything else held.
Eigen::VectorXd CauseFitter::roughly_sized(const Hypothesis& start, const FitOptions& options,
                                           const SeriesWeights& weights, int& evaluations) const {
    const std::vector<OpenNumber>& numbers = start.causes.back()->numbers;
    const bool is_a_step = std::any_of(numbers.begin(), numbers.end(), [](const OpenNumber& number) {
        return number.kind == OpenNumber::Kind::step;
    });
    const std::vector<double> factors =
        is_a_step ? std::vector<double>{0.96, 0.97, 0.98, 0.99, 1.0, 1.01, 1.02, 1.03, 1.04}
                  : std::vector<double>{0.1, 0.3, 0.6, 1.0, 1.5, 2.0, 4.0, 8.0};
    Eigen::MatrixXd tried = start.coordinates.replicate(1, static_cast<Eigen::Index>(factors.size()));
    bool has_size = false;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        if (!numbers[k].is_size()) continue;
        has_size = true;
        const auto row = start.coordinates.size() - static_cast<Eigen::Index>(numbers.size() - k);
        for (std::size_t f = 0; f < factors.size(); ++f)
            tried(row, static_cast<Eigen::Index>(f)) *= factors[f];
    }
    if (!has_size) return start.coordinates;
    Eigen::Index best = 0;
    Eigen::MatrixXd left = residuals(start, tried, options.left_out);
    apply(weights, left);
    left.colwise().squaredNorm().minCoeff(&best);
    evaluations += static_cast<int>(factors.size());
    return tried.col(best);
}

// A search with small differences may end at a ripple, and one that begins with wide ones may pass by the
// minimum: the better of the two, where they end apart.
CauseFit CauseFitter::fit_over_ripples(const Hypothesis& start, const FitOptions& options) const {
    CauseFit fit = fit_with({}, start, options, max_iterations, fine_step);
    if (fit.sum_of_squares > options.pruned_sum_of_squares) return fit;
    const CauseFit rough = fit_with({}, start, options, rough_iterations, rough_step);
    int evaluations = fit.evaluations + rough.evaluations;
    const bool is_apart = (rough.coordinates - fit.coordinates).cwiseAbs().maxCoeff() > rough_step;
    if (is_apart && rough.sum_of_squares < not_converged * fit.sum_of_squares) {
        CauseFit other = fit_with({}, rough.hypothesis(), options, max_iterations, fine_step);
        evaluations += other.evaluations;
        if (other.sum_of_squares < fit.sum_of_squares) fit = std::move(other);
    }
    fit.evaluations = evaluations;
    return fit;
}

CauseFit CauseFitter::fit(const Hypothesis& start, const FitOptions& options) const {
    int evaluations = 0;
    Hypothesis from = start;
    if (options.any_size && !start.causes.empty())
        from.coordinates =
            roughly_sized(start, options,
                          options.balanced ? balancing_weights(data_residuals({&start, 1}, options.left_out))
                                           : options.weights,
                          evaluations);
    if (!options.balanced) {
        // With weights a search begins where another one ended.
        CauseFit fit = options.weights.empty()
                           ? fit_over_ripples(from, options)
                           : fit_with(options.weights, from, options, max_iterations, fine_step);
        fit.evaluations += evaluations;
        return fit;
    }
    // As long as the weights still move, a rough search is enough.
    constexpr int max_rounds = 4;
    constexpr double clearly = 1.3;
    CauseFit fit;
    SeriesWeights weights = balancing_weights(data_residuals({&from, 1}, options.left_out));
    bool holds = false;
    for (int round = 0; round < max_rounds; ++round) {
        const bool is_last = holds || round + 1 == max_rounds;
        fit = is_last || options.is_close ? fit_with(weights, from, options, max_iterations, fine_step)
                                          : fit_with(weights, from, options, rough_iterations, rough_step);
        evaluations += fit.evaluations;
        if (is_last || fit.sum_of_squares > not_converged * options.pruned_sum_of_squares) break;
        from.coordinates = fit.coordinates;
        const SeriesWeights next = balancing_weights(fit.residuals);
        holds = std::equal(next.begin(), next.end(), weights.begin(), [](double one, double other) {
            return std::max(one, other) < clearly * std::min(one, other);
        });
        if (holds && options.is_close) break;
        if (!holds) weights = next;
    }
    fit.evaluations = evaluations;
    return fit;
}

WideDerivatives CauseFitter::wide_derivatives(const Hypothesis& at) const {
    std::vector<Hypothesis> moved = {at};
    for (Eigen::Index k = 0; k < at.coordinates.size(); ++k) {
        moved.push_back(at);
        moved.back().coordinates[k] += rough_step;
    }
    const Eigen::MatrixXd values = data_residuals(moved);
    return {at.coordinates, values.col(0),
            (values.rightCols(values.cols() - 1).colwise() - values.col(0)) / rough_step};
}

// A further cause changes little of what the other numbers of a set do. So only that cause's own
// derivatives are computed; a search corrects the others along its steps, and computes them where they lead
// nowhere.
LeastSquaresFit CauseFitter::beside_known(const Hypothesis& start, const SeriesWeights& weights,
                                          const WideDerivatives& known) const {
    const Eigen::Index count = start.coordinates.size();
    const Eigen::Index own = count - known.at.size();
    Eigen::MatrixXd tried = start.coordinates.replicate(1, 1 + own);
    for (Eigen::Index k = 0; k < own; ++k) tried(known.at.size() + k, 1 + k) += rough_step;
    const Eigen::MatrixXd values = residuals(start, tried);
    LeastSquaresFit fit;
    fit.parameters = start.coordinates;
    fit.residuals = values.col(0);
    fit.jacobian.resize(values.rows(), count);
    fit.jacobian.topLeftCorner(known.jacobian.rows(), known.at.size()) = known.jacobian;
    const Eigen::VectorXd priors = fit.residuals.tail(count);
    for (Eigen::Index k = 0; k < known.at.size(); ++k) {
        Eigen::VectorXd moved = start.coordinates;
        moved[k] += rough_step;
        fit.jacobian.col(k).tail(count) = (prior_residuals(start, moved) - priors) / rough_step;
    }
    fit.jacobian.rightCols(own) = (values.rightCols(own).colwise() - fit.residuals) / rough_step;
    apply(weights, fit.residuals);
    apply(weights, fit.jacobian);
    fit.evaluations = static_cast<int>(1 + own);
    return fit;
}

CauseFit CauseFitter::rough_fit(std::span<const Hypothesis> starts, const SeriesWeights& weights,
                                const WideDerivatives& known) const {
    constexpr int few_iterations = 3;
    constexpr std::size_t max_continued = 2;
    int evaluations = 0;
    std::vector<Hypothesis> sized(starts.begin(), starts.end());
    for (Hypothesis& each : sized) each.coordinates = roughly_sized(each, {}, weights, evaluations);
    if (sized.size() > max_continued) {
        evaluations += static_cast<int>(sized.size());
        Eigen::MatrixXd left = data_residuals(sized);
        apply(weights, left);
        const Eigen::VectorXd sums = left.colwise().squaredNorm();
        std::vector<Eigen::Index> order(sized.size());
        std::iota(order.begin(), order.end(), Eigen::Index{0});
        std::stable_sort(order.begin(), order.end(),
                         [&](Eigen::Index a, Eigen::Index b) { return sums[a] < sums[b]; });
        std::vector<Hypothesis> best;
        for (std::size_t k = 0; k < max_continued; ++k)
            best.push_back(sized[static_cast<std::size_t>(order[k])]);
        sized = std::move(best);
    }
    std::optional<CauseFit> least;
    for (const Hypothesis& from : sized) {
        LeastSquaresOptions search = search_from(from);
        search.difference_step = rough_step;
        search.max_iterations = few_iterations;
        const ResidualFunction function = weighted(from, weights, {});
        const bool is_known = known.at.size() > 0 && from.coordinates.head(known.at.size()) == known.at;
        CauseFit fit =
            completed(from, weights,
                      is_known ? fit_least_squares(function, beside_known(from, weights, known), search)
                               : fit_least_squares(function, from.coordinates, search));
        evaluations += fit.evaluations;
        Eigen::VectorXd weighted = fit.residuals;
        apply(weights, weighted);
        fit.sum_of_squares = weighted.squaredNorm();
        if (!least || fit.sum_of_squares < least->sum_of_squares) least = std::move(fit);
    }
    least->evaluations = evaluations;
    return *least;
}

std::optional<CauseFit> CauseFitter::rough_fit_from_held_sizes(const Hypothesis& start,
                                                               const SeriesWeights& weights) const {
    constexpr double sizes[] = {0.2, 0.6, 2.0, 6.0};  // of a typical one
    constexpr int few_iterations = 4;
    const std::vector<OpenNumber>& numbers = start.causes.back()->numbers;
    const auto own = static_cast<Eigen::Index>(numbers.size());
    const Eigen::Index others = start.coordinates.size() - own;
    LeastSquaresOptions search = search_from(start);
    search.lower_bounds = Eigen::VectorXd(search.lower_bounds.head(others));
    search.difference_step = rough_step;
    search.max_iterations = few_iterations;
    std::optional<Hypothesis> best;
    double min_sum_of_squares = std::numeric_limits<double>::infinity();
    int evaluations = 0;
    for (const double size : sizes) {
        Hypothesis held = start;
        for (Eigen::Index k = 0; k < own; ++k) {
            double& coordinate = held.coordinates[others + k];
            if (numbers[static_cast<std::size_t>(k)].is_size() && coordinate != 0.0)
                coordinate = std::copysign(size, coordinate);
        }
        if (held.coordinates == start.coordinates) continue;
        const ResidualFunction of_all = weighted(held, weights, {});
        const auto of_others = [&](const Eigen::MatrixXd& coordinates) {
            Eigen::MatrixXd all = held.coordinates.replicate(1, coordinates.cols());
            all.topRows(others) = coordinates;
            return of_all(all);
        };
        const Eigen::VectorXd from = held.coordinates.head(others);
        const LeastSquaresFit found = fit_least_squares(of_others, from, search);
        evaluations += found.evaluations;
        if (found.sum_of_squares >= min_sum_of_squares) continue;
        min_sum_of_squares = found.sum_of_squares;
        held.coordinates.head(others) = found.parameters;
        best = std::move(held);
    }
    if (!best) return std::nullopt;
    CauseFit fit = rough_fit({&*best, 1}, weights);
    fit.evaluations += evaluations;
    return fit;
}

LeastSquaresOptions CauseFitter::search_from(const Hypothesis& start) const {
    LeastSquaresOptions search;
    search.differences = Differences::forward;
    search.difference_step = fine_step;
    search.parameter_tolerance = 1e-3;
    search.lower_bounds = lower_bounds_of(start);
    search.max_iterations = max_iterations;
    search.jacobian_at_end = false;
    search.secant = true;
    search.dampings_at_once = dampings_at_once;
    search.min_decrease = 2.0 * min_gain * prior_weight_ * prior_weight_;
    return search;
}

ResidualFunction CauseFitter::weighted(const Hypothesis& hypothesis, const SeriesWeights& weights,
                                       std::optional<LeftOut> left_out) const {
    return [this, hypothesis, weights, left_out](const Eigen::MatrixXd& coordinates) {
        Eigen::MatrixXd all = residuals(hypothesis, coordinates, left_out);
        apply(weights, all);
        return all;
    };
}

CauseFit CauseFitter::fit_with(const SeriesWeights& weights, const Hypothesis& start,
                               const FitOptions& options, int iterations, double difference_step) const {
    LeastSquaresOptions search = search_from(start);
    search.difference_step = difference_step;
    search.max_iterations = iterations;
    // The evidence of a drive is read off it. Of a band, of which often one run was recorded, a search that
    // goes on with it finds sets that other runs do not confirm.
    search.jacobian_at_end = recording_.is_undescribed_drive() && iterations == max_iterations;
    // Sums with weights say nothing of the best sum so far, which has none.
    if (weights.empty()) search.pruned_sum_of_squares = options.pruned_sum_of_squares;
    return completed(
        start, weights,
        fit_least_squares(weighted(start, weights, options.left_out), start.coordinates, search));
}

// The Jacobian of all parts, without the rows of the one left out, leads close to the fit without it (the
// infinitesimal jackknife), so that few steps are left.
std::vector<CauseFit> CauseFitter::fits_without(const CauseFit& all, std::span<const LeftOut> parts) const {
    const Hypothesis start = all.hypothesis();
    LeastSquaresFit known;
    known.parameters = all.coordinates;
    known.residuals = all.residuals;
    apply(all.weights, known.residuals);
    LeastSquaresOptions search = search_from(start);
    search.max_iterations = 3;
    known.jacobian = jacobian_at(weighted(start, all.weights, {}), known.parameters, known.residuals, search);
    std::vector<CauseFit> fits;
    for (const LeftOut& part : parts) {
        LeastSquaresFit from = known;
        set_zero(part, from.residuals);
        set_zero(part, from.jacobian);
        fits.push_back(completed(start, all.weights,
                                 fit_least_squares(weighted(start, all.weights, part), from, search)));
    }
    return fits;
}

CauseFit CauseFitter::completed(const Hypothesis& hypothesis, const SeriesWeights& weights,
                                const LeastSquaresFit& found) const {
    CauseFit fit;
    fit.causes = hypothesis.causes;
    fit.bench = hypothesis.bench;
    fit.weights = weights;
    fit.coordinates = found.parameters;
    fit.residuals = found.residuals;
    apply(inverse_of(weights), fit.residuals);
    integrate(fit, found.jacobian);
    fit.sum_of_squares = weights.empty() ? found.sum_of_squares : fit.residuals.squaredNorm();
    fit.evaluations = found.evaluations;
    fit.converged = found.converged;
    return fit;
}

}  // namespace capstan::gap
