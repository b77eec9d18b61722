#pragma once

#include <cmath>

namespace capstan {

/// A cable that is soft at low tension and stiffens (E31): strain = T / EA + toe (1 - exp(-T / T_toe)), the
/// toe strain being what the strands must give before all of them bear.
struct NonlinearStiffness {
    double toe_strain = 0.0;
    double toe_tension_N = 10.0;

    double strain(double tension_N, double axial_stiffness_N) const {
        return tension_N / axial_stiffness_N - toe_strain * std::expm1(-tension_N / toe_tension_N);
    }
    double strain_per_N(double tension_N, double axial_stiffness_N) const {
        return 1.0 / axial_stiffness_N + toe_strain / toe_tension_N * std::exp(-tension_N / toe_tension_N);
    }
};

}  // namespace capstan
