#include "capstan/gap/screening.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace capstan::gap {

namespace {

struct Explained {
    double left = 0.0;        // sum of squares
    Eigen::VectorXd weights;  // of the last directions
};

// Inner products of what is left to explain and of directions that may explain it.
struct Products {
    double of_target = 0.0;
    Eigen::VectorXd of_both;
    Eigen::MatrixXd of_directions;
};

// Least squares of the target on the directions. The last ones belong to causes; where `at_least_none` is
// true the weight cannot be negative, and a negative one is replaced by zero.
Explained explained(Products products, const std::vector<bool>& at_least_none) {
    const auto own = static_cast<Eigen::Index>(at_least_none.size());
    const Eigen::Index count = products.of_both.size();
    const Eigen::Index known = count - own;
    for (Eigen::Index tries = 0;; ++tries) {
        const Eigen::MatrixXd& normal = products.of_directions;
        const Eigen::VectorXd weights =
            (normal + 1e-9 * normal.trace() * Eigen::MatrixXd::Identity(count, count))
                .ldlt()
                .solve(-products.of_both);
        bool against = false;
        for (Eigen::Index k = known; tries <= own && k < count; ++k) {
            if (!at_least_none[static_cast<std::size_t>(k - known)] || !(weights[k] < 0.0)) continue;
            products.of_both[k] = 0.0;
            products.of_directions.row(k).setZero();
            products.of_directions.col(k).setZero();
            against = true;
        }
        if (against) continue;
        const double left =
            products.of_target + 2.0 * weights.dot(products.of_both) + weights.dot(normal * weights);
        return {left, weights.tail(own)};
    }
}

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

std::vector<Probe> probes_of(std::span<const CandidateCause> causes, const Hypothesis& present,
                             const PromisingStarts& promising) {
    std::vector<Probe> probes;
    for (const CandidateCause& cause : causes) {
        if (cause.effect == "none" ||
            std::find(present.causes.begin(), present.causes.end(), &cause) != present.causes.end())
            continue;
        const auto known = promising.find(&cause);
        if (known == promising.end()) {
            add_probes(cause, probes);
        } else {
            std::copy(known->second.begin(), known->second.end(), std::back_inserter(probes));
        }
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

// Inner products of what is left, and of what present numbers and probes change, with the numbers' priors as
// part of the residuals.
class LinearModel {
  public:
    LinearModel(const CauseFitter& fitter, std::span<const Probe> probes, const Hypothesis& present,
                const SeriesWeights& weights)
        : known_(present.coordinates.size()) {
        constexpr double step = 0.02;
        std::vector<Hypothesis> hypotheses = {present};
        for (Eigen::Index k = 0; k < known_; ++k) {
            hypotheses.push_back(present);
            hypotheses.back().coordinates[k] += step;
        }
        for (const Probe& probe : probes) {
            first_of_.push_back(static_cast<Eigen::Index>(hypotheses.size()));
            for (const Eigen::VectorXd& direction : probe.directions)
                hypotheses.push_back(with_cause(present, probe.cause, direction));
        }
        Eigen::MatrixXd data = fitter.data_residuals(hypotheses);
        fitter.apply(weights, data);
        Eigen::MatrixXd all(data.rows() + known_, data.cols());
        for (Eigen::Index k = 0; k < all.cols(); ++k)
            all.col(k) << data.col(k),
                fitter.prior_residuals(present,
                                       hypotheses[static_cast<std::size_t>(k)].coordinates.head(known_));
        all.rightCols(all.cols() - 1).colwise() -= Eigen::VectorXd(all.col(0));
        all.middleCols(1, known_) /= step;
        products_.noalias() = all.transpose() * all;
    }

    /// With the directions of these probes, beside the present numbers.
    Explained explained_by(std::span<const Probe> probes, const std::vector<std::size_t>& some) const {
        std::vector<Eigen::Index> columns = present();
        std::vector<bool> at_least_none;
        for (const std::size_t probe : some) {
            for (std::size_t k = 0; k < probes[probe].sizes.size(); ++k) {
                columns.push_back(first_of_[probe] + static_cast<Eigen::Index>(k));
                at_least_none.push_back(probes[probe].cause->numbers[probes[probe].sizes[k]].kind ==
                                        OpenNumber::Kind::size);
            }
        }
        return explained({products_(0, 0), products_(columns, 0), products_(columns, columns)},
                         at_least_none);
    }
    /// What is left where a probe with one direction is present as it is.
    double left_there(std::size_t probe) const {
        const Eigen::Index own = first_of_[probe];
        const std::vector<Eigen::Index> columns = present();
        return explained({products_(0, 0) + 2.0 * products_(own, 0) + products_(own, own),
                          products_(columns, 0) + products_(columns, own), products_(columns, columns)},
                         {})
            .left;
    }

  private:
    std::vector<Eigen::Index> present() const {
        std::vector<Eigen::Index> columns;
        for (Eigen::Index k = 1; k <= known_; ++k) columns.push_back(k);
        return columns;
    }

    Eigen::Index known_;
    std::vector<Eigen::Index> first_of_;  // of each probe's directions
    Eigen::MatrixXd products_;            // of what is left, of present numbers, of the probes' directions
};

// A step or an oscillation fits only where its size is met closely, so a linear estimate means
// nothing.
bool fits_only_there(const Probe& probe) {
    return probe.sizes.size() == 1 && (probe.cause->numbers[probe.sizes[0]].kind == OpenNumber::Kind::step ||
                                       probe.cause->numbers[probe.sizes[0]].resonates);
}

// One for each probe, in their order.
std::vector<Screened> screened(const CauseFitter& fitter, std::span<const Probe> probes,
                               const Hypothesis& present, const SeriesWeights& weights) {
    const LinearModel model(fitter, probes, present, weights);
    std::vector<Screened> all;
    for (std::size_t k = 0; k < probes.size(); ++k) {
        const Probe& probe = probes[k];
        Screened screened{probe.cause, probe.start, std::numeric_limits<double>::infinity()};
        if (!fits_only_there(probe)) {
            const Explained along = model.explained_by(probes, {k});
            screened = {probe.cause, sized(probe, along.weights), along.left};
        }
        if (probe.directions.size() == 1) {
            const double left = model.left_there(k);
            if (left < screened.sum_of_squares) screened = {probe.cause, probe.start, left};
        }
        all.push_back(screened);
    }
    return all;
}

// `screened`: one for each probe. The probes of a cause follow one another. An inertia rings at one frequency
// and a ripple has one number of periods, whatever acts beside them, so that a few starts are enough later.
void keep_promising(const std::vector<Probe>& probes, const std::vector<Screened>& screened,
                    PromisingStarts& promising) {
    constexpr std::size_t many = 20;
    constexpr std::size_t kept = 8;
    for (std::size_t first = 0, end = 0; first < probes.size(); first = end) {
        while (end < probes.size() && probes[end].cause == probes[first].cause) ++end;
        if (end - first <= many) continue;
        std::vector<std::size_t> order(end - first);
        std::iota(order.begin(), order.end(), first);
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return screened[a].sum_of_squares < screened[b].sum_of_squares;
        });
        order.resize(kept);
        std::sort(order.begin(), order.end());
        for (const std::size_t each : order) promising[probes[first].cause].push_back(probes[each]);
    }
}

void sort_by_promise(std::vector<Screened>& all) {
    std::stable_sort(all.begin(), all.end(), [](const Screened& a, const Screened& b) {
        return a.sum_of_squares < b.sum_of_squares;
    });
}

}  // namespace

std::vector<Screened> screen(const CauseFitter& fitter, std::span<const CandidateCause> causes,
                             const Hypothesis& present, const SeriesWeights& weights,
                             PromisingStarts* promising) {
    static const PromisingStarts none;
    const std::vector<Probe> probes = probes_of(causes, present, promising != nullptr ? *promising : none);
    std::vector<Screened> all = screened(fitter, probes, present, weights);
    if (promising != nullptr) keep_promising(probes, all, *promising);
    std::vector<Screened> best;
    for (Screened& each : all) {
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
    std::vector<Screened> all = screened(fitter, probes_of({&cause, 1}, present, {}), present, weights);
    sort_by_promise(all);
    return all;
}

std::vector<ScreenedPair> screen_pairs(const CauseFitter& fitter, std::span<const CandidateCause> causes,
                                       const Hypothesis& present, const SeriesWeights& weights,
                                       const PromisingStarts& promising) {
    const std::vector<Probe> probes = probes_of(causes, present, promising);
    const LinearModel model(fitter, probes, present, weights);
    std::map<std::pair<const CandidateCause*, const CandidateCause*>, ScreenedPair> best;
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const Probe& first = probes[i];
        if (first.sizes.empty() || fits_only_there(first)) continue;
        for (std::size_t j = i + 1; j < probes.size(); ++j) {
            const Probe& second = probes[j];
            if (second.cause == first.cause || second.sizes.empty() || fits_only_there(second)) continue;
            const Explained along = model.explained_by(probes, {i, j});
            const auto [known, is_new] = best.try_emplace({first.cause, second.cause});
            if (!is_new && known->second.sum_of_squares <= along.left) continue;
            const auto of_first = static_cast<Eigen::Index>(first.sizes.size());
            known->second = {first.cause, sized(first, along.weights.head(of_first)), second.cause,
                             sized(second, along.weights.tail(along.weights.size() - of_first)), along.left};
        }
    }
    std::vector<ScreenedPair> all;
    // In the order of the causes, not of their addresses.
    for (const CandidateCause& first : causes) {
        for (const CandidateCause& second : causes) {
            const auto found = best.find({&first, &second});
            if (found != best.end()) all.push_back(found->second);
        }
    }
    std::stable_sort(all.begin(), all.end(), [](const ScreenedPair& a, const ScreenedPair& b) {
        return a.sum_of_squares < b.sum_of_squares;
    });
    return all;
}

}  // namespace capstan::gap
