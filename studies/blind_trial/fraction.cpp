#include "capstan/blind_trial/fraction.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace capstan::gap_trial {

namespace {

constexpr double z95 = 1.959963984540054;

// Wilson's interval: middle and half width.
std::pair<double, double> wilson(double fraction, int of) {
    const double n = of;
    const double middle = (fraction + z95 * z95 / (2.0 * n)) / (1.0 + z95 * z95 / n);
    const double half =
        z95 / (1.0 + z95 * z95 / n) * std::sqrt(fraction * (1.0 - fraction) / n + z95 * z95 / (4.0 * n * n));
    return {middle, half};
}

}  // namespace

double Fraction::low() const {
    if (of == 0) return 0.0;
    const auto [middle, half] = wilson(value(), of);
    return std::max(0.0, middle - half);
}

double Fraction::high() const {
    if (of == 0) return 1.0;
    const auto [middle, half] = wilson(value(), of);
    return std::min(1.0, middle + half);
}

}  // namespace capstan::gap_trial
