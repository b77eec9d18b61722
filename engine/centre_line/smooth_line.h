#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>

namespace capstan {

using LinePoints = Eigen::Matrix<double, Eigen::Dynamic, 3>;  // points x coordinates

/// The smoothest line through noisy points (E46): least squares with a penalty on the third derivative by
/// length, so that neither a straight line nor a constant curvature is penalised. The penalty is the largest
/// that leaves the points no further from the line than their noise.
class SmoothLine {
  public:
    SmoothLine(const LinePoints& points_m, double noise_m);

    const LinePoints& points_m() const { return smooth_m_; }
    /// Length over which smoothing ties points together [m].
    double reach_m() const { return reach_m_; }
    /// Other points at the same lengths, smoothed by the same penalty.
    LinePoints smoothed(const LinePoints& points_m) const { return solver_.solve(points_m); }

  private:
    void smooth(const LinePoints& points_m, double noise_m);

    Eigen::VectorXd at_m_;    // points: length along the line
    Eigen::VectorXd weight_;  // of the penalty between four points
    LinePoints smooth_m_;
    double reach_m_ = 0.0;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

/// The change of direction by length at every point [1/m]; at an end that of its neighbour (E47).
LinePoints curvature_of(const LinePoints& points_m);
/// The length that each point stands for [m].
Eigen::VectorXd lengths_of(const LinePoints& points_m);

}  // namespace capstan
