#include "capstan/gap/next_experiment.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace capstan::gap {

namespace {

constexpr double decided = 0.95;
constexpr double min_probability = 0.05;
constexpr std::size_t largest_group = 3;

// The coordinates of a hypothesis, each moved a little: a column each, the first as it is.
Eigen::MatrixXd moved_a_little(const Eigen::VectorXd& coordinates, double step) {
    Eigen::MatrixXd moved = coordinates.replicate(1, coordinates.size() + 1);
    for (Eigen::Index k = 0; k < coordinates.size(); ++k) moved(k, k + 1) += step;
    return moved;
}

Eigen::MatrixXd differences(const Eigen::MatrixXd& residuals, double step) {
    return (residuals.rightCols(residuals.cols() - 1).colwise() - residuals.col(0)) / step;
}

// What the recording determines about one explanation's numbers.
struct Known {
    Hypothesis hypothesis;
    Eigen::VectorXd residuals;  // data and priors, in parts that count as one independent sample
    Eigen::MatrixXd jacobian;
};

// What no change of the numbers takes away.
Eigen::VectorXd min_residuals(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residuals) {
    return residuals - jacobian * jacobian.colPivHouseholderQr().solve(residuals);
}

constexpr double step = 1e-2;  // of a coordinate

// The numbers are the best there are, so that only what they cannot take away is left. Fronts make ripples,
// at one of which a search may have ended.
Known known_of(const CauseFitter& fitter, const CauseFit& fit) {
    const double weight = std::sqrt(fitter.independent_samples() / fitter.determined_rows());
    const Eigen::MatrixXd residuals =
        weight * fitter.residuals(fit.hypothesis(), moved_a_little(fit.coordinates, step));
    const Eigen::MatrixXd jacobian = differences(residuals, step);
    return {fit.hypothesis(), min_residuals(jacobian, residuals.col(0)), jacobian};
}

// The chi-square that an explanation leaves on data that another one generated.
double unexplained_by(const Known& rival, const CauseFitter& planned, const Hypothesis& truth) {
    const double weight = std::sqrt(planned.independent_samples() / planned.determined_rows());
    const Eigen::MatrixXd moved = moved_a_little(rival.hypothesis.coordinates, step);
    std::vector<Hypothesis> all = {truth};
    for (Eigen::Index column = 0; column < moved.cols(); ++column)
        all.push_back({rival.hypothesis.causes, moved.col(column), rival.hypothesis.bench});
    const Eigen::MatrixXd residuals = weight * planned.data_residuals(all);
    const Eigen::MatrixXd rival_change = residuals.rightCols(moved.cols());

    const Eigen::Index before = rival.residuals.size();
    Eigen::MatrixXd jacobian(before + rival_change.rows(), rival.jacobian.cols());
    jacobian << rival.jacobian, differences(rival_change, step);
    Eigen::VectorXd off(jacobian.rows());
    off << rival.residuals, rival_change.col(0) - residuals.col(0);
    return std::max(0.0, min_residuals(jacobian, off).squaredNorm() - rival.residuals.squaredNorm());
}

// The bench's response without noise. It sets the model's floor.
Recording answered(Recording recording, const EffectsTwinOptions& options, const BenchNumbers& numbers) {
    EffectsTwinOptions every_sample = options;
    every_sample.stride = 1;
    const TwinRun run = EffectsTwin(recording, every_sample).run(0, numbers);
    for (std::size_t channel = 0; channel < run.values.size(); ++channel) {
        if (!run.values[channel].empty()) recording.runs.front().values[channel] = run.values[channel];
    }
    return recording;
}

}  // namespace

bool is_probably_unknown(std::span<const WeighedHypothesis> weighed) {
    double unknown = 0.0;
    for (const WeighedHypothesis& each : weighed) unknown += each.with_unknown ? each.probability : 0.0;
    return unknown > 0.5;
}

std::vector<WeighedHypothesis> non_identifiable(std::span<const WeighedHypothesis> weighed) {
    const bool is_unknown = is_probably_unknown(weighed);
    if (weighed.empty() || (weighed.front().probability >= decided && !is_unknown)) return {};
    std::vector<WeighedHypothesis> group;
    for (const WeighedHypothesis& each : weighed) {
        const bool competes = is_unknown ? each.effects != std::vector<std::string>{"none"}
                                         : each.probability >= min_probability;
        if (!each.with_unknown && competes && group.size() < largest_group) group.push_back(each);
    }
    if (group.size() < 2) group.clear();
    return group;
}

NonIdentifiable discriminating_experiments(const Recording& recording, const CauseFitter& fitter,
                                           std::span<const WeighedHypothesis> group, int threads) {
    NonIdentifiable result;
    std::vector<Known> known;
    for (const WeighedHypothesis& each : group) {
        result.group.push_back(each.effects);
        known.push_back(known_of(fitter, each.fit->fit));
    }
    if (group.size() < 2) return result;
    const Hypothesis& leader = known.front().hypothesis;
    for (const Experiment& experiment : possible_experiments(recording)) {
        const EffectsTwinOptions options = fitter.twin().options();
        const Recording planned = answered(experiment.recording, options, bench_numbers(leader));
        const CauseFitter planned_fitter(planned, options, threads);
        double min_chi_square = std::numeric_limits<double>::infinity();
        for (std::size_t truth = 0; truth < known.size(); ++truth) {
            for (std::size_t rival = 0; rival < known.size(); ++rival) {
                if (rival == truth) continue;
                min_chi_square = std::min(
                    min_chi_square, unexplained_by(known[rival], planned_fitter, known[truth].hypothesis));
            }
        }
        const double separation = std::sqrt(min_chi_square / Evidence::overstated);
        result.experiments.push_back({experiment.kind, experiment.name, experiment.description,
                                      0.5 * std::erfc(-0.5 * separation / std::sqrt(2.0))});
    }
    std::stable_sort(result.experiments.begin(), result.experiments.end(),
                     [](const ExperimentScore& a, const ExperimentScore& b) {
                         return a.discrimination_probability > b.discrimination_probability;
                     });
    return result;
}

}  // namespace capstan::gap
