#pragma once

#include <cmath>

namespace capstan {

/// A friction coefficient that changes with the normal force per length N' = T / R (E23, Hertzian contact of
/// a sheath's liner): mu = mu_d (N' / N'_0)^(exponent - 1).
struct LoadDependentFriction {
    double exponent = 1.0;  ///< 1: Coulomb
    double reference_N_per_m = 10.0;

    /// Factor on mu_d; held within what a power law can be trusted for.
    double factor(double normal_force_N_per_m) const {
        constexpr double least = 0.05;  // of the reference
        constexpr double most = 20.0;
        if (exponent == 1.0) return 1.0;
        const double ratio = normal_force_N_per_m / reference_N_per_m;
        const double held = ratio < least ? least : ratio > most ? most : ratio;
        return std::pow(held, exponent - 1.0);
    }
};

}  // namespace capstan
