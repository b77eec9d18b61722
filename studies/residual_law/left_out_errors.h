#pragma once

#include <Eigen/Core>
#include <vector>

namespace capstan::residual_law {

/// The normal equations of a part of the data for all columns, as means over its samples: every part counts
/// alike.
struct NormalEquations {
    Eigen::MatrixXd columns;  // columns x columns
    Eigen::VectorXd target;   // columns: with the residual
    double target_square = 0.0;
    /// How much the part counts when it is left out: less where that asks for an extrapolation.
    double importance = 1.0;

    NormalEquations& operator+=(const NormalEquations& other);
};

/// `columns`: samples x columns; of the samples of one part.
NormalEquations normal_equations(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual);

/// Columns that are fitted together, each with a ridge in parts of its mean square; 0: free.
struct ChosenColumns {
    std::vector<Eigen::Index> columns;
    std::vector<double> ridge;  // columns

    void add(Eigen::Index column, double with_ridge);
};

/// The data in parts that are left out in turn.
struct PartedData {
    std::vector<NormalEquations> parts;
    std::vector<NormalEquations> others;  // parts: the sum of all others
    NormalEquations all;                  ///< the sum of all
};

PartedData in_parts(std::vector<NormalEquations> parts);

/// Weights of the chosen columns by least squares with their ridges.
Eigen::VectorXd fitted_weights(const NormalEquations& data, const ChosenColumns& chosen);

/// Mean square of one part with given weights.
double mean_square(const NormalEquations& part, const ChosenColumns& chosen, const Eigen::VectorXd& weights);

/// Mean square of each part with the weights that the other parts give, and these weights.
struct LeftOutErrors {
    std::vector<double> squares;           // parts
    std::vector<double> importance;        // parts
    std::vector<Eigen::VectorXd> weights;  // parts
    double mean() const;                   ///< over the parts as they count
};

LeftOutErrors left_out_errors(const PartedData& data, const ChosenColumns& chosen);

}  // namespace capstan::residual_law
