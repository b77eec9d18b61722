#include "capstan/residual_law/left_out_errors.h"

#include <Eigen/Cholesky>
#include <numeric>

namespace capstan::residual_law {

namespace {

// Columns that say the same share a weight instead of cancelling each other.
constexpr double min_ridge = 1e-6;
constexpr double no_column_square = 1e-12;

}  // namespace

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
    columns += other.columns;
    target += other.target;
    target_square += other.target_square;
    return *this;
}

NormalEquations normal_equations(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual) {
    const auto samples = static_cast<double>(columns.rows());
    return {columns.transpose() * columns / samples, columns.transpose() * residual / samples,
            residual.squaredNorm() / samples};
}

void ChosenColumns::add(Eigen::Index column, double with_ridge) {
    columns.push_back(column);
    ridge.push_back(with_ridge);
}

PartedData in_parts(std::vector<NormalEquations> parts) {
    PartedData data;
    data.all = parts.front();
    for (std::size_t k = 1; k < parts.size(); ++k) data.all += parts[k];
    for (const NormalEquations& part : parts)
        data.others.push_back({data.all.columns - part.columns, data.all.target - part.target,
                               data.all.target_square - part.target_square});
    data.parts = std::move(parts);
    return data;
}

Eigen::VectorXd fitted_weights(const NormalEquations& data, const ChosenColumns& chosen) {
    if (chosen.columns.empty()) return Eigen::VectorXd(0);
    Eigen::MatrixXd normal = data.columns(chosen.columns, chosen.columns);
    for (std::size_t k = 0; k < chosen.ridge.size(); ++k) {
        const auto at = static_cast<Eigen::Index>(k);
        normal(at, at) += (chosen.ridge[k] + min_ridge) * normal(at, at) + no_column_square;
    }
    return normal.ldlt().solve(data.target(chosen.columns));
}

double LeftOutErrors::mean() const {
    return std::inner_product(squares.begin(), squares.end(), importance.begin(), 0.0) /
           std::accumulate(importance.begin(), importance.end(), 0.0);
}

double mean_square(const NormalEquations& part, const ChosenColumns& chosen, const Eigen::VectorXd& weights) {
    if (chosen.columns.empty()) return part.target_square;
    const Eigen::MatrixXd normal = part.columns(chosen.columns, chosen.columns);
    const Eigen::VectorXd target = part.target(chosen.columns);
    return part.target_square - 2.0 * weights.dot(target) + weights.dot(normal * weights);
}

LeftOutErrors left_out_errors(const PartedData& data, const ChosenColumns& chosen) {
    LeftOutErrors errors;
    for (std::size_t k = 0; k < data.parts.size(); ++k) {
        errors.weights.push_back(fitted_weights(data.others[k], chosen));
        errors.importance.push_back(data.parts[k].importance);
        errors.squares.push_back(mean_square(data.parts[k], chosen, errors.weights.back()));
    }
    return errors;
}

}  // namespace capstan::residual_law
