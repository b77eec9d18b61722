#include "capstan/centre_line/smooth_line.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace capstan {

namespace {

// Rounding leaves nothing of a larger one, and it is far beyond what leaves a parabola.
constexpr double largest_log_penalty = 11.0;
constexpr double smallest_log_penalty = -6.0;

// Lengths along noisy points: chords of ten deviations of noise, which it lengthens by 1%, shared evenly by
// the points between.
Eigen::VectorXd first_lengths_m(const LinePoints& points, double noise_m) {
    const Eigen::Index count = points.rows();
    Eigen::VectorXd at = Eigen::VectorXd::Zero(count);
    Eigen::Index from = 0;
    for (Eigen::Index to = 1; to < count; ++to) {
        const double chord_m = (points.row(to) - points.row(from)).norm();
        if (chord_m < 10.0 * noise_m && to + 1 < count) continue;
        for (Eigen::Index k = from + 1; k <= to; ++k)
            at[k] = at[from] + std::max(chord_m, noise_m) * static_cast<double>(k - from) /
                                   static_cast<double>(to - from);
        from = to;
    }
    return at;
}

Eigen::VectorXd lengths_along_m(const LinePoints& points) {
    Eigen::VectorXd at = Eigen::VectorXd::Zero(points.rows());
    for (Eigen::Index k = 1; k < points.rows(); ++k)
        at[k] = at[k - 1] + (points.row(k) - points.row(k - 1)).norm();
    return at;
}

// Third derivatives by divided differences, times the root of the length that each stands for.
Eigen::SparseMatrix<double> third_derivatives(const Eigen::VectorXd& at) {
    const Eigen::Index count = at.size();
    Eigen::SparseMatrix<double> third(count - 3, count);
    for (Eigen::Index row = 0; row + 3 < count; ++row) {
        const double weight = 6.0 * std::sqrt((at[row + 3] - at[row]) / 3.0);
        for (Eigen::Index j = row; j <= row + 3; ++j) {
            double product = 1.0;
            for (Eigen::Index other = row; other <= row + 3; ++other)
                if (other != j) product *= at[j] - at[other];
            third.insert(row, j) = weight / product;
        }
    }
    return third;
}

// Where the curvature changes more than in most places, a bend begins or ends: the penalty grows there with
// the size of the change and not with its square, which would spread it.
Eigen::VectorXd weights_of(const Eigen::VectorXd& change) {
    std::vector<double> sorted(change.begin(), change.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double usual = std::max(3.0 * *middle, 1e-300);
    return (1.0 + (change.array() / usual).square()).rsqrt();
}

}  // namespace

SmoothLine::SmoothLine(const LinePoints& points_m, double noise_m)
    : at_m_(first_lengths_m(points_m, noise_m)) {
    // Lengths and weights follow from the smooth line, which follows from them.
    constexpr int rounds = 10;
    weight_ = Eigen::VectorXd::Ones(points_m.rows() - 3);
    for (int round = 0; round < rounds; ++round) {
        smooth(points_m, noise_m);
        at_m_ = lengths_along_m(smooth_m_);
    }
}

void SmoothLine::smooth(const LinePoints& points_m, double noise_m) {
    const Eigen::Index count = points_m.rows();
    const double spacing_m = at_m_[count - 1] / static_cast<double>(count - 1);
    const Eigen::SparseMatrix<double> third = third_derivatives(at_m_ / spacing_m);
    const Eigen::SparseMatrix<double> penalty = third.transpose() * weight_.asDiagonal() * third;
    Eigen::SparseMatrix<double> identity(count, count);
    identity.setIdentity();
    const auto solve = [&](double log_penalty) {
        solver_.compute(identity + std::pow(10.0, log_penalty) * penalty);
        smooth_m_ = solver_.solve(points_m);
    };
    // One standard deviation beyond the expected sum of squares.
    const double terms = 3.0 * static_cast<double>(count);
    const double allowed = (terms + std::sqrt(2.0 * terms)) * noise_m * noise_m;
    double low = smallest_log_penalty;
    double high = largest_log_penalty;
    solve(high);
    if ((points_m - smooth_m_).squaredNorm() > allowed) {
        while (high - low > 0.01) {
            const double middle = 0.5 * (low + high);
            solve(middle);
            ((points_m - smooth_m_).squaredNorm() > allowed ? high : low) = middle;
        }
        solve(low);
        high = low;
    }
    weight_ = weights_of((third * smooth_m_).rowwise().norm());
    reach_m_ = std::numbers::pi * std::pow(10.0, high / 6.0) * spacing_m;
}

LinePoints curvature_of(const LinePoints& points_m) {
    const Eigen::Index count = points_m.rows();
    LinePoints curvature = LinePoints::Zero(count, 3);
    for (Eigen::Index k = 1; k + 1 < count; ++k) {
        const Eigen::RowVector3d before = points_m.row(k) - points_m.row(k - 1);
        const Eigen::RowVector3d behind = points_m.row(k + 1) - points_m.row(k);
        curvature.row(k) =
            2.0 * (behind.normalized() - before.normalized()) / (before.norm() + behind.norm());
    }
    curvature.row(0) = curvature.row(1);
    curvature.row(count - 1) = curvature.row(count - 2);
    return curvature;
}

Eigen::VectorXd lengths_of(const LinePoints& points_m) {
    const Eigen::Index count = points_m.rows();
    Eigen::VectorXd lengths = Eigen::VectorXd::Zero(count);
    for (Eigen::Index k = 0; k + 1 < count; ++k) {
        const double half_m = 0.5 * (points_m.row(k + 1) - points_m.row(k)).norm();
        lengths[k] += half_m;
        lengths[k + 1] += half_m;
    }
    return lengths;
}

}  // namespace capstan
