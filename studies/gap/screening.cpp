#include "capstan/gap/screening.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace capstan::gap {

namespace {

struct Explained {
    double left = 0.0;        // sum of squares
    Eigen::VectorXd weights;  // of the last directions
};

// Least squares of `target` on the columns of `directions`. The last columns belong to a cause; where
// `at_least_none` is true the weight cannot be negative, and a negative one is replaced by zero.
Explained explained(const Eigen::VectorXd& target, Eigen::MatrixXd directions,
                    const std::vector<bool>& at_least_none) {
    const auto own = static_cast<Eigen::Index>(at_least_none.size());
    const Eigen::Index known = directions.cols() - own;
    for (Eigen::Index tries = 0;; ++tries) {
        const Eigen::MatrixXd normal = directions.transpose() * directions;
        const Eigen::VectorXd weights =
            (normal + 1e-9 * normal.trace() * Eigen::MatrixXd::Identity(normal.rows(), normal.cols()))
                .ldlt()
                .solve(-directions.transpose() * target);
        bool against = false;
        for (Eigen::Index k = 0; tries <= own && k < own; ++k) {
            if (!at_least_none[static_cast<std::size_t>(k)] || !(weights[known + k] < 0.0)) continue;
            directions.col(known + k).setZero();
            against = true;
        }
        if (!against) return {(target + directions * weights).squaredNorm(), weights.tail(own)};
    }
}

// One cause at one place and of one shape, with a direction for each of its sizes.
struct Probe {
    const CandidateCause* cause = nullptr;
    Eigen::VectorXd start;                    // of the cause's own numbers
    std::vector<Eigen::VectorXd> directions;  // each with one size present, the others absent
    std::vector<std::size_t> sizes;           // which of its numbers
};

// All combinations of the starts of the numbers that are not sizes.
std::vector<Eigen::VectorXd> shapes_of(const CandidateCause& cause) {
    std::vector<Eigen::VectorXd> grid = {Eigen::VectorXd(0)};
    for (const OpenNumber& number : cause.numbers) {
        std::vector<Eigen::VectorXd> longer;
        for (const Eigen::VectorXd& begun : grid) {
            for (const double start : number.is_size() ? std::vector<double>{0.0} : number.starts()) {
                Eigen::VectorXd next(begun.size() + 1);
                next << begun, start;
                longer.push_back(next);
            }
        }
        grid = longer;
    }
    return grid;
}

void add_probes(const CandidateCause& cause, std::vector<Probe>& probes) {
    std::vector<std::size_t> sizes;
    for (std::size_t k = 0; k < cause.numbers.size(); ++k) {
        if (cause.numbers[k].is_size() && !cause.numbers[k].is_detail) sizes.push_back(k);
    }
    for (const Eigen::VectorXd& shape : shapes_of(cause)) {
        // Friction that is too small to hold a pulley does nothing of what more of it does, so that each
        // size is also tried alone, at values of its own.
        for (const std::size_t alone : sizes) {
            if (sizes.size() > 1 && cause.numbers[alone].kind != OpenNumber::Kind::size) continue;
            for (const double size : cause.numbers[alone].starts()) {
                Eigen::VectorXd start = shape;
                start[static_cast<Eigen::Index>(alone)] = size;
                probes.push_back({&cause, start, {start}, {alone}});
            }
        }
        if (sizes.size() == 1) continue;
        Probe probe{&cause, shape, {}, sizes};
        for (const std::size_t size : sizes) {
            Eigen::VectorXd alone = shape;
            alone[static_cast<Eigen::Index>(size)] = 1.0;
            probe.directions.push_back(alone);
        }
        probes.push_back(probe);
    }
}

std::vector<Probe> probes_of(std::span<const CandidateCause> causes, const Hypothesis& present) {
    std::vector<Probe> probes;
    for (const CandidateCause& cause : causes) {
        if (cause.effect != "none" &&
            std::find(present.causes.begin(), present.causes.end(), &cause) == present.causes.end())
            add_probes(cause, probes);
    }
    return probes;
}

// Where a search should start: with the sizes that least squares found.
Eigen::VectorXd sized(const Probe& probe, const Eigen::VectorXd& weights) {
    constexpr double least = 0.1;
    constexpr double most = 10.0;
    Eigen::VectorXd start = probe.start;
    for (std::size_t k = 0; k < probe.sizes.size(); ++k) {
        const auto number = static_cast<Eigen::Index>(probe.sizes[k]);
        const double weight = weights[static_cast<Eigen::Index>(k)];
        const double size = std::copysign(std::clamp(std::abs(weight), least, most), weight);
        start[number] = probe.directions[k][number] * size;
    }
    return start;
}

// One for each probe, in their order.
std::vector<Screened> screened(const CauseFitter& fitter, std::span<const Probe> probes,
                               const Hypothesis& present, const SeriesWeights& weights) {
    constexpr double step = 0.02;
    const Eigen::Index known = present.coordinates.size();
    std::vector<Hypothesis> hypotheses = {present};
    for (Eigen::Index k = 0; k < known; ++k) {
        hypotheses.push_back(present);
        hypotheses.back().coordinates[k] += step;
    }
    for (const Probe& probe : probes) {
        for (const Eigen::VectorXd& direction : probe.directions)
            hypotheses.push_back(with_cause(present, probe.cause, direction));
    }
    Eigen::MatrixXd data = fitter.data_residuals(hypotheses);
    fitter.apply(weights, data);

    // The priors of the present numbers are part of the residuals.
    const Eigen::Index rows = data.rows() + known;
    const auto with_priors = [&](std::size_t hypothesis) {
        Eigen::VectorXd all(rows);
        all << data.col(static_cast<Eigen::Index>(hypothesis)),
            fitter.prior_residuals(present, hypotheses[hypothesis].coordinates.head(known));
        return all;
    };
    const Eigen::VectorXd here = with_priors(0);
    Eigen::MatrixXd directions(rows, known);
    for (Eigen::Index k = 0; k < known; ++k)
        directions.col(k) = (with_priors(static_cast<std::size_t>(k) + 1) - here) / step;

    std::vector<Screened> all;
    std::size_t next = static_cast<std::size_t>(known) + 1;
    for (const Probe& probe : probes) {
        Eigen::MatrixXd together(rows, known + static_cast<Eigen::Index>(probe.directions.size()));
        together.leftCols(known) = directions;
        std::vector<bool> at_least_none;
        Eigen::VectorXd there;
        for (std::size_t k = 0; k < probe.directions.size(); ++k) {
            there = with_priors(next++);
            together.col(known + static_cast<Eigen::Index>(k)) = there - here;
            at_least_none.push_back(probe.cause->numbers[probe.sizes[k]].kind == OpenNumber::Kind::size);
        }
        // A step or an oscillation fits only where its size is met closely, so a linear estimate means
        // nothing.
        const bool fits_only_there =
            probe.sizes.size() == 1 && (probe.cause->numbers[probe.sizes[0]].kind == OpenNumber::Kind::step ||
                                        probe.cause->numbers[probe.sizes[0]].resonates);
        Screened screened{probe.cause, probe.start, std::numeric_limits<double>::infinity()};
        if (!fits_only_there) {
            const Explained along = explained(here, together, at_least_none);
            screened = {probe.cause, sized(probe, along.weights), along.left};
        }
        if (probe.directions.size() == 1) {
            const double left = explained(there, directions, {}).left;
            if (left < screened.sum_of_squares) screened = {probe.cause, probe.start, left};
        }
        all.push_back(screened);
    }
    return all;
}

void sort_by_promise(std::vector<Screened>& all) {
    std::stable_sort(all.begin(), all.end(), [](const Screened& a, const Screened& b) {
        return a.sum_of_squares < b.sum_of_squares;
    });
}

}  // namespace

std::vector<Screened> screen(const CauseFitter& fitter, std::span<const CandidateCause> causes,
                             const Hypothesis& present, const SeriesWeights& weights) {
    std::vector<Screened> best;
    for (Screened& each : screened(fitter, probes_of(causes, present), present, weights)) {
        if (best.empty() || best.back().cause != each.cause) {
            best.push_back(std::move(each));
        } else if (each.sum_of_squares < best.back().sum_of_squares) {
            best.back() = std::move(each);
        }
    }
    sort_by_promise(best);
    return best;
}

std::vector<Screened> screen_each_start(const CauseFitter& fitter, const CandidateCause& cause,
                                        const Hypothesis& present, const SeriesWeights& weights) {
    std::vector<Screened> all = screened(fitter, probes_of({&cause, 1}, present), present, weights);
    sort_by_promise(all);
    return all;
}

}  // namespace capstan::gap
