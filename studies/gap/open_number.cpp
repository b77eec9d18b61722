// The coordinates in which a search moves, and what is known of them beforehand.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "capstan/gap/candidate_cause.h"

namespace capstan::gap {

namespace {

// Three decades of sizes, so close that one of them keeps in step with an oscillation for a few periods: by
// an eighth, which is a sixteenth of a frequency.
std::vector<double> close_sizes() {
    constexpr double least = 0.1;
    constexpr double most = 100.0;
    constexpr double ratio = 1.125;
    std::vector<double> sizes;
    for (double size = least; size < most; size *= ratio) sizes.push_back(size);
    return sizes;
}

}  // namespace

double OpenNumber::value(double coordinate) const {
    double value = 0.0;
    switch (kind) {
        case Kind::size:
        case Kind::step:
            value = absent + std::max(0.0, coordinate) * (typical - absent);
            break;
        case Kind::signed_size:
            value = absent + coordinate * (typical - absent);
            break;
        case Kind::shape:
            value = typical * std::exp(coordinate);
            break;
        case Kind::periods:
            value = std::round(coordinate);
            break;
        case Kind::place:
            value = typical * coordinate;
            break;
    }
    return std::clamp(value, low, high);
}

bool OpenNumber::is_at_bound(double value) const {
    if (kind == Kind::place || kind == Kind::step || low == high) return false;
    return value >= high || (value <= low && low != absent);
}

double OpenNumber::prior_mean() const {
    return kind == Kind::place ? 0.5 : 0.0;
}

double OpenNumber::prior_std() const {
    switch (kind) {
        case Kind::size:
        case Kind::signed_size:
        case Kind::step:
            return 30.0;
        case Kind::periods:
            return std::numeric_limits<double>::infinity();  // nothing pulls at it: a search does not move it
        case Kind::shape:
        case Kind::place:
            return 1.0;
    }
    return 1.0;
}

double OpenNumber::prior_width(double coordinate) const {
    const double root_two_pi = std::sqrt(2.0 * std::numbers::pi);
    const double decades = std::log(100.0);
    switch (kind) {
        case Kind::size:
        case Kind::step:
            return std::abs(coordinate) * decades / root_two_pi;
        case Kind::signed_size:
            return 2.0 * std::abs(coordinate) * decades / root_two_pi;
        case Kind::place:
            return 1.0 / root_two_pi;  // anywhere along the cable
        case Kind::shape:
            return prior_std();
        case Kind::periods:
            return 0.0;
    }
    return 0.0;
}

double OpenNumber::log_choices() const {
    return kind == Kind::periods ? std::log(high - low + 1.0) : 0.0;
}

std::vector<double> OpenNumber::starts() const {
    switch (kind) {
        case Kind::size:
            return resonates ? close_sizes() : std::vector<double>{0.5, 3.0};
        case Kind::signed_size:
            return {-1.0, 1.0};
        case Kind::shape:
            return {0.0};
        case Kind::periods: {
            constexpr int tried = 36;
            std::vector<double> starts;
            for (int k = 0; k < tried && low + k <= high; ++k) starts.push_back(low + k);
            return starts;
        }
        case Kind::step:
            return {1.0};
        case Kind::place:
            return {0.1, 0.3, 0.5, 0.7, 0.9};
    }
    return {0.0};
}

}  // namespace capstan::gap
