#pragma once

#include <algorithm>
#include <cmath>

// Each law of the cable is written once, as a template over its number, in the section CAPSTAN_LAWS_BEGIN ...
// CAPSTAN_LAWS_END of its header. Here the number is a double. The rig's kernel compiles the same sections
// again for each instruction set, with a SIMD vector as the number (rig/lane_laws-inl.h).

#define CAPSTAN_LAWS_BEGIN namespace capstan::laws {
#define CAPSTAN_LAWS_END }
#define CAPSTAN_LAW inline

namespace capstan::laws {

// The operations that a law may use beside + - * /.
template <class Number>
Number constant(double value) {
    return value;
}
inline double exp(double x) {
    return std::exp(x);
}
inline double pow(double base, double exponent) {
    return std::pow(base, exponent);
}
inline double abs(double x) {
    return std::abs(x);
}
inline double negative(double x) {
    return -x;
}
inline double max(double a, double b) {
    return std::max(a, b);
}
inline double min(double a, double b) {
    return std::min(a, b);
}
/// 1 - exp(-x).
inline double saturation(double x) {
    return -std::expm1(-x);
}
/// numerator / denominator; vectors multiply by the reciprocal.
inline double quotient(double numerator, double denominator) {
    return numerator / denominator;
}
inline bool is_equal(double a, double b) {
    return a == b;
}
inline bool is_greater(double a, double b) {
    return a > b;
}
inline bool either(bool a, bool b) {
    return a || b;
}
inline bool is_not(bool condition) {
    return !condition;
}
inline bool all(bool condition) {
    return condition;
}
inline double select(bool condition, double if_true, double if_false) {
    return condition ? if_true : if_false;
}

}  // namespace capstan::laws

namespace capstan {

/// A torque on a pulley and its derivative with respect to the angle.
struct Torque {
    double value_Nm = 0.0;
    double per_rad = 0.0;
};

}  // namespace capstan
