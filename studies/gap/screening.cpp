#include "capstan/gap/screening.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace capstan::gap {

namespace {

// Least squares of `target` on the columns of `directions`: what is left. The last direction may be a
// cause's, which cannot be there less than not at all: against it, it explains nothing.
double left_after(const Eigen::VectorXd& target, const Eigen::MatrixXd& directions, bool last_is_a_cause) {
    const Eigen::MatrixXd normal = directions.transpose() * directions;
    const Eigen::VectorXd weights =
        (normal + 1e-9 * normal.trace() * Eigen::MatrixXd::Identity(normal.rows(), normal.cols()))
            .ldlt()
            .solve(-directions.transpose() * target);
    if (last_is_a_cause && weights[weights.size() - 1] < 0.0)
        return left_after(target, directions.leftCols(directions.cols() - 1), false);
    return (target + directions * weights).squaredNorm();
}

struct Start {
    const CandidateCause* cause = nullptr;
    Eigen::VectorXd coordinates;  // of the cause's own numbers
};

std::vector<Start> starts_of(const std::vector<CandidateCause>& causes, const Hypothesis& present) {
    std::vector<Start> starts;
    for (const CandidateCause& cause : causes) {
        if (cause.effect == "none" ||
            std::find(present.causes.begin(), present.causes.end(), &cause) != present.causes.end())
            continue;
        for (const Eigen::VectorXd& start : start_grid(cause)) starts.push_back({&cause, start});
    }
    return starts;
}

}  // namespace

std::vector<Screened> screen(const CauseFitter& fitter, const std::vector<CandidateCause>& causes,
                             const Hypothesis& present) {
    constexpr double step = 0.02;
    const Eigen::Index known = present.coordinates.size();
    const std::vector<Start> starts = starts_of(causes, present);
    std::vector<Hypothesis> hypotheses = {present};
    for (Eigen::Index k = 0; k < known; ++k) {
        hypotheses.push_back(present);
        hypotheses.back().coordinates[k] += step;
    }
    for (const Start& start : starts) {
        Hypothesis hypothesis = present;
        if (start.coordinates.size() > 0) {
            hypothesis.causes.push_back(start.cause);
            hypothesis.coordinates.resize(known + start.coordinates.size());
            hypothesis.coordinates << present.coordinates, start.coordinates;
        }
        hypotheses.push_back(hypothesis);
    }
    const Eigen::MatrixXd data = fitter.data_residuals(hypotheses);

    // The priors of what is known already go along.
    const Eigen::Index rows = data.rows() + known;
    const auto with_priors = [&](std::size_t hypothesis) {
        Eigen::VectorXd all(rows);
        all << data.col(static_cast<Eigen::Index>(hypothesis)),
            fitter.prior_residuals(present.causes, hypotheses[hypothesis].coordinates.head(known));
        return all;
    };
    const Eigen::VectorXd here = with_priors(0);
    Eigen::MatrixXd directions(rows, known + 1);
    for (Eigen::Index k = 0; k < known; ++k)
        directions.col(k) = (with_priors(static_cast<std::size_t>(k) + 1) - here) / step;

    std::vector<Screened> all;
    for (std::size_t k = 0; k < starts.size(); ++k) {
        const auto& [cause, coordinates] = starts[k];
        double left = 0.0;
        if (coordinates.size() == 0) {  // a nominal number that may go far: its direction is there already
            left = left_after(here, directions.leftCols(known), false);
        } else {
            const Eigen::VectorXd there = with_priors(static_cast<std::size_t>(known) + 1 + k);
            directions.col(known) = there - here;
            left = std::min(left_after(here, directions, true),
                            left_after(there, directions.leftCols(known), false));
        }
        if (all.empty() || all.back().cause != cause) {
            all.push_back({cause, coordinates, left});
        } else if (left < all.back().sum_of_squares) {
            all.back() = {cause, coordinates, left};
        }
    }
    std::stable_sort(all.begin(), all.end(), [](const Screened& a, const Screened& b) {
        return a.sum_of_squares < b.sum_of_squares;
    });
    return all;
}

}  // namespace capstan::gap
