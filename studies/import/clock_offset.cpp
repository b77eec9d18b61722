#include "capstan/import/clock_offset.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "capstan/recording/channel_range.h"

namespace capstan::imports {

namespace {

constexpr std::array yields = {0.02, 0.06, 0.15, 0.3, 0.6};  // of the channel's span
constexpr std::size_t coarse_samples = 6000;
constexpr int parts = 4;
constexpr std::size_t fewest_fitted = 100;
// A channel of which the others explain less does not show its clock well enough to be shifted.
constexpr double largest_unexplained = 0.05;
// Of one that repeats a single other channel, such as a torque beside the tension at its pulley, the noise.
constexpr double largest_unexplained_of_a_copy = 3e-4;

// An elastic-plastic element: it moves with the input until it yields.
std::vector<double> stop_element(const std::vector<double>& input, double yield) {
    std::vector<double> force(input.size(), 0.0);
    for (std::size_t k = 1; k < input.size(); ++k)
        force[k] = std::clamp(force[k - 1] + input[k] - input[k - 1], -yield, yield);
    return force;
}

// Over a few samples, against noise.
std::vector<double> speed_of(const std::vector<double>& values) {
    constexpr std::size_t half = 3;
    std::vector<double> speed(values.size(), 0.0);
    for (std::size_t k = 0; k < values.size(); ++k) {
        const std::size_t from = k < half ? 0 : k - half;
        const std::size_t to = std::min(k + half, values.size() - 1);
        if (to > from) speed[k] = (values[to] - values[from]) / static_cast<double>(to - from);
    }
    return speed;
}

Eigen::MatrixXd features_of(const std::vector<ClockReference>& others) {
    std::vector<std::vector<double>> columns;
    for (const ClockReference& other : others) {
        const double span = range_of(other.values).span();
        if (span <= 0.0) continue;
        columns.push_back(other.values);
        for (const double yield :
             other.with_friction ? std::span<const double>(yields) : std::span<const double>())
            columns.push_back(stop_element(other.values, yield * span));
        if (other.is_angle) columns.push_back(speed_of(other.values));
    }
    Eigen::MatrixXd features(others.empty() ? 0 : static_cast<Eigen::Index>(others[0].values.size()),
                             static_cast<Eigen::Index>(columns.size() + 1));
    for (std::size_t column = 0; column < columns.size(); ++column) {
        const Eigen::Map<const Eigen::VectorXd> values(columns[column].data(), features.rows());
        const double mean = values.mean();
        const double size = std::sqrt((values.array() - mean).square().mean());
        features.col(static_cast<Eigen::Index>(column)) = (values.array() - mean) / (size > 0.0 ? size : 1.0);
    }
    features.rightCols(1).setOnes();
    return features;
}

/// The unexplained part of a channel's variance at integer shifts in samples.
class ShiftFit {
  public:
    ShiftFit(const Eigen::MatrixXd& features, Eigen::Index first, Eigen::Index count)
        : features_(features.middleRows(first, count)), first_(first) {
        Eigen::MatrixXd gram = features_.transpose() * features_;
        gram.diagonal().array() += 1e-8 * static_cast<double>(count);
        solver_.compute(gram);
    }

    double unexplained(const Eigen::VectorXd& channel, Eigen::Index shift) const {
        const auto values = channel.segment(first_ + shift, features_.rows());
        const double mean = values.mean();
        const double variation = (values.array() - mean).square().sum();
        if (variation <= 0.0) return 1.0;
        const Eigen::VectorXd right = features_.transpose() * values;
        const Eigen::VectorXd weights = solver_.solve(right);
        const double explained = right.dot(weights) - mean * mean * static_cast<double>(values.size());
        return std::clamp(1.0 - explained / variation, 0.0, 1.0);
    }

  private:
    Eigen::MatrixXd features_;
    Eigen::Index first_;
    Eigen::LDLT<Eigen::MatrixXd> solver_;
};

struct BestShift {
    double shift = 0.0;  ///< samples, by a parabola through the three smallest
    double unexplained = 1.0;
    bool inside = false;  ///< not at an end of the range
    double reach = 0.0;   ///< to the farthest shift that is as good within the model's error
};

BestShift best_shift(const ShiftFit& fit, const Eigen::VectorXd& channel, Eigen::Index centre,
                     Eigen::Index range, double model_error) {
    std::vector<double> left;
    for (Eigen::Index shift = centre - range; shift <= centre + range; ++shift)
        left.push_back(fit.unexplained(channel, shift));
    const auto best = std::min_element(left.begin(), left.end());
    const auto at = best - left.begin();
    BestShift found{static_cast<double>(centre - range + at), *best,
                    best != left.begin() && best != left.end() - 1};
    const double as_good = std::max(2.0 * *best, *best + model_error);
    const auto first = std::find_if(left.begin(), left.end(), [&](double each) { return each <= as_good; });
    const auto last = std::find_if(left.rbegin(), left.rend(), [&](double each) { return each <= as_good; });
    found.reach = static_cast<double>(std::max(best - first, last.base() - 1 - best));
    if (found.inside) {
        const double curvature =
            left[static_cast<std::size_t>(at - 1)] + left[static_cast<std::size_t>(at + 1)] - 2 * *best;
        if (curvature > 0.0)
            found.shift += 0.5 *
                           (left[static_cast<std::size_t>(at - 1)] - left[static_cast<std::size_t>(at + 1)]) /
                           curvature;
    }
    return found;
}

// Half the 95% interval of the mean of independent estimates (Student), of which there are at least two.
double half_interval(const std::vector<double>& estimates) {
    constexpr std::array quantiles = {12.706, 4.303, 3.182};  // 97.5% of 1, 2 and 3 degrees of freedom
    const auto count = static_cast<double>(estimates.size());
    double mean = 0.0;
    for (const double each : estimates) mean += each / count;
    double squares = 0.0;
    for (const double each : estimates) squares += (each - mean) * (each - mean);
    return quantiles.at(estimates.size() - 2) * std::sqrt(squares / (count - 1.0) / count);
}

std::vector<double> every(const std::vector<double>& values, std::size_t step) {
    std::vector<double> kept;
    for (std::size_t k = 0; k < values.size(); k += step) kept.push_back(values[k]);
    return kept;
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::optional<ClockOffset> offset_beside(const std::vector<double>& channel,
                                         const std::vector<ClockReference>& others, double sample_rate_Hz,
                                         double longest_s, double model_error) {
    if (channel.size() < fewest_fitted || others.empty()) return std::nullopt;
    const std::size_t step = std::max<std::size_t>(1, channel.size() / coarse_samples);
    std::vector<ClockReference> thinned;
    for (const ClockReference& other : others)
        thinned.push_back({every(other.values, step), other.is_angle, other.with_friction});
    const Eigen::VectorXd coarse = vector_of(every(channel, step));
    const auto range = std::min<Eigen::Index>(
        static_cast<Eigen::Index>(longest_s * sample_rate_Hz / static_cast<double>(step)) + 1,
        coarse.size() / (others.size() == 1 && !others[0].with_friction ? 3 : 4));
    const ShiftFit complete(features_of(thinned), range, coarse.size() - 2 * range);
    const BestShift first = best_shift(complete, coarse, 0, range, model_error);
    if (first.unexplained > largest_unexplained || !first.inside) return std::nullopt;

    // Finely, in quarters of the samples.
    const Eigen::VectorXd all = vector_of(channel);
    const Eigen::MatrixXd features = features_of(others);
    const auto centre = static_cast<Eigen::Index>(std::llround(first.shift * static_cast<double>(step)));
    const auto near = static_cast<Eigen::Index>(2 * step + 3);
    const Eigen::Index begin = std::max<Eigen::Index>(0, near - centre);
    const Eigen::Index rows = all.size() - std::max<Eigen::Index>(0, centre + near) - begin;
    const Eigen::Index length = rows / parts;
    if (length < static_cast<Eigen::Index>(fewest_fitted / parts)) return std::nullopt;
    const ShiftFit fine(features, begin, rows);
    const BestShift found = best_shift(fine, all, centre, near, model_error);
    std::vector<double> estimates;
    for (Eigen::Index part = 0; part < parts; ++part) {
        const BestShift quarter =
            best_shift(ShiftFit(features, begin + part * length, length), all, centre, near, model_error);
        if (quarter.inside && quarter.unexplained < largest_unexplained) estimates.push_back(quarter.shift);
    }
    if (!found.inside || found.unexplained > largest_unexplained || estimates.size() < 2) return std::nullopt;
    // A channel that shows something k samples later has a clock that is k samples behind.
    const double wide = first.reach * static_cast<double>(step);
    return ClockOffset{-found.shift / sample_rate_Hz,
                       std::max(half_interval(estimates), wide) / sample_rate_Hz, found.unexplained,
                       fine.unexplained(all, 0)};
}

}  // namespace

std::optional<ClockOffset> find_clock_offset(const std::vector<double>& channel,
                                             const std::vector<ClockReference>& others, double sample_rate_Hz,
                                             double longest_s, double model_error) {
    auto found = offset_beside(channel, others, sample_rate_Hz, longest_s, model_error);
    if (others.size() < 2 || (found && found->uncertainty_s <= 1.0 / sample_rate_Hz)) return found;
    // Few samples do not determine the weights of many elements; a copy of a single channel needs one. An
    // angle's speed, which looks like a shift, is then not beside it, so that no torque is compared with an
    // angle.
    for (const ClockReference& other : others) {
        if (other.is_angle) continue;
        const auto alone =
            offset_beside(channel, {{other.values, false, false}}, sample_rate_Hz, longest_s, model_error);
        if (alone && alone->unexplained < largest_unexplained_of_a_copy &&
            (!found || alone->uncertainty_s < found->uncertainty_s))
            found = alone;
    }
    return found;
}

}  // namespace capstan::imports
