#pragma once

#include <span>

#include "capstan/estimation/feasible_curve.h"

namespace capstan {

/// add_log_likelihood(), and likeliest_point() of the result, in one pass.
int add_log_likelihood_and_find_peak(std::span<const double> before, std::span<const double> sensor,
                                     std::span<double> result);

/// A place between two neighbouring points of the curve, or at one.
struct CurvePlace {
    int point = 0;
    int neighbour = 0;
    double fraction = 0.0;  ///< of the way to the neighbour
};

/// The top of the parabola through the most likely point and its two neighbours; at the curve's ends the
/// point itself.
CurvePlace likeliest_place(std::span<const double> log_likelihood, int peak);

/// maximum_likelihood() where `peak`, its most likely point, is known already.
void maximum_likelihood_around(const FeasibleCurve& curve, std::span<const double> log_likelihood, int peak,
                               std::span<double> tension_N);

}  // namespace capstan
