#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

namespace capstan {

/// Torque error at which a search is done [N m]: far below any torque cell, far above rounding.
inline constexpr double torque_tolerance_Nm = 1e-10;

/// How a search for the angle that gives a torque went.
struct AngleSearch {
    double angle_rad = 0.0;
    double torque_residual_Nm = 0.0;  ///< torque at the angle less the torque asked for
    int iterations = 0;               ///< trials; 0: the angle was prescribed, nothing to search
    bool converged = true;            ///< the residual is within torque_tolerance_Nm
    /// Not converged because the torque jumps over the one asked for at this angle: with mu_s above mu_d,
    /// where an end has just stopped or a front breaks away, static friction holds any torque within the
    /// jump.
    bool at_jump = false;
};

/// Where a search starts and what it knows beforehand.
struct AngleSearchStart {
    double angle_rad = 0.0;
    double steepest_Nm_per_rad = 0.0;  ///< no torque grows faster; sign: whether it rises or falls
    double stop_at_Nm = torque_tolerance_Nm;
};

/// The angle at which `torque_error_Nm(angle)` is zero (E17). The error is piecewise linear in the angle and
/// monotone but for jumps where static friction gives way (mu_s above mu_d), so: bracket from the start with
/// a growing step, then a secant within the bracket that halves it when the secant is slow. Where the error
/// jumps over zero the search ends at the bracket's better side and says so. The last trial is always at the
/// angle returned.
template <std::invocable<double> TorqueError>
AngleSearch search_angle(const AngleSearchStart& start, TorqueError&& torque_error_Nm) {
    // Far beyond what any cable stands.
    constexpr double farthest_rad = 1e4;
    constexpr int max_trials = 200;
    // The step overshoots the secant a little, so that the next trial closes the bracket.
    constexpr double overshoot = 1.2;
    constexpr double min_growth = 2.0;
    constexpr double max_growth = 100.0;

    struct Trial {
        double angle_rad;
        double error_Nm;
    };
    int trials = 0;
    const auto trial = [&](double angle_rad) -> Trial {
        ++trials;
        return {angle_rad, torque_error_Nm(angle_rad)};
    };
    const auto done = [&](const Trial& t) { return std::abs(t.error_Nm) <= start.stop_at_Nm; };
    const auto answer = [&](const Trial& t) -> AngleSearch {
        return {t.angle_rad, t.error_Nm, trials, std::abs(t.error_Nm) <= torque_tolerance_Nm, false};
    };

    const Trial first = trial(start.angle_rad);
    if (done(first)) return answer(first);
    const double direction = (first.error_Nm < 0.0) == (start.steepest_Nm_per_rad > 0.0) ? 1.0 : -1.0;
    const double rounding_rad = 8.0 * std::numeric_limits<double>::epsilon() * std::abs(start.angle_rad);

    Trial near = first;
    Trial far = first;
    double distance_rad =
        std::max(overshoot * std::abs(first.error_Nm / start.steepest_Nm_per_rad), rounding_rad + 1e-16);
    while (true) {
        far = trial(start.angle_rad + direction * distance_rad);
        if (done(far)) return answer(far);
        if (std::signbit(far.error_Nm) != std::signbit(first.error_Nm)) break;
        const double slope = (far.error_Nm - near.error_Nm) / (far.angle_rad - near.angle_rad);
        const double secant_rad = std::abs(far.angle_rad - start.angle_rad) + std::abs(far.error_Nm / slope);
        const bool approaching = std::abs(far.error_Nm) < std::abs(near.error_Nm);
        const double wanted_rad = approaching ? overshoot * secant_rad : min_growth * distance_rad;
        near = far;
        distance_rad = std::clamp(wanted_rad, min_growth * distance_rad, max_growth * distance_rad);
        if (distance_rad > farthest_rad) return answer(trial(first.angle_rad));
    }

    Trial last = far;
    double near_weight = 1.0;  // Illinois: halves the error of a side that stays
    double far_weight = 1.0;
    double width_rad = std::abs(far.angle_rad - near.angle_rad);
    for (int inside = 1; trials < max_trials; ++inside) {
        const double near_error = near_weight * near.error_Nm;
        const double far_error = far_weight * far.error_Nm;
        double angle_rad =
            near.angle_rad + (far.angle_rad - near.angle_rad) * near_error / (near_error - far_error);
        const bool check_progress = inside % 3 == 0;
        if (check_progress) {
            const double now_rad = std::abs(far.angle_rad - near.angle_rad);
            if (now_rad > 0.5 * width_rad) angle_rad = 0.5 * (near.angle_rad + far.angle_rad);
            width_rad = now_rad;
        }
        if (angle_rad == near.angle_rad || angle_rad == far.angle_rad) {
            angle_rad = 0.5 * (near.angle_rad + far.angle_rad);
            if (angle_rad == near.angle_rad || angle_rad == far.angle_rad) break;  // neighbours in doubles
        }
        last = trial(angle_rad);
        if (done(last)) return answer(last);
        if (std::signbit(last.error_Nm) == std::signbit(first.error_Nm)) {
            near = last;
            near_weight = 1.0;
            far_weight *= 0.5;
        } else {
            far = last;
            far_weight = 1.0;
            near_weight *= 0.5;
        }
    }
    const Trial& better = std::abs(near.error_Nm) < std::abs(far.error_Nm) ? near : far;
    AngleSearch search = answer(better.angle_rad == last.angle_rad ? last : trial(better.angle_rad));
    search.at_jump = !search.converged && trials < max_trials;
    return search;
}

}  // namespace capstan
