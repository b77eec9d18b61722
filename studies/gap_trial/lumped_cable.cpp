#include "capstan/gap_trial/lumped_cable.h"

#include <algorithm>
#include <cmath>

// Compiled a second time for processors with vectors of four doubles. Without fused multiply-adds both give
// the same bits. Which to take is decided before the thread sanitizer is ready to watch that being decided.
#ifdef __SANITIZE_THREAD__
#define CAPSTAN_WIDE
#else
#define CAPSTAN_WIDE [[gnu::target_clones("avx2", "default")]]
#endif

namespace capstan::gap_trial {

namespace {

double overlap_m(double from_m, double to_m, const Stretch& stretch) {
    return std::max(0.0, std::min(to_m, stretch.to_m) - std::max(from_m, stretch.from_m));
}

double length_of(const std::vector<CurvaturePiece>& pieces) {
    double length_m = 0.0;
    for (const CurvaturePiece& piece : pieces) length_m += piece.length_m;
    return length_m;
}

double wrap_between(const std::vector<CurvaturePiece>& pieces, double from_m, double to_m) {
    double wrap_rad = 0.0;
    double reached_m = 0.0;
    for (const CurvaturePiece& piece : pieces) {
        wrap_rad += overlap_m(from_m, to_m, {reached_m, reached_m + piece.length_m}) / piece.bend_radius_m;
        reached_m += piece.length_m;
    }
    return wrap_rad;
}

// Wrap of a bend, spread evenly over its stretch, that falls between two positions.
double fraction_between(const Stretch& stretch, double from_m, double to_m) {
    const double length_m = stretch.to_m - stretch.from_m;
    return length_m > 0.0 ? overlap_m(from_m, to_m, stretch) / length_m : 0.0;
}

}  // namespace

LumpedCable::LumpedCable(const LumpedCableNumbers& numbers, const TrueEffects& effects, int masses,
                         double time_step_s)
    : effects_(effects),
      numbers_(numbers),
      masses_(masses),
      spacing_m_(length_of(numbers.curvature) / masses),
      time_step_s_(time_step_s),
      speed_per_N_(time_step_s / (numbers.mass_kg_per_m * spacing_m_)),
      slow_pretension_N_(numbers.pretension_N) {
    const auto count = static_cast<std::size_t>(masses);
    for (auto* each : {&position_m_, &speed_m_per_s_, &still_wrap_rad_, &moving_wrap_rad_, &hold_sliding_,
                       &hold_static_, &bristle_, &slow_speed_m_per_s_, &warmth_})
        each->assign(count, 0.0);
    for (auto* each :
         {&spring_N_per_m_, &sheath_m_per_N_, &relaxed_m_, &crept_m_, &crept_fast_m_, &crept_slow_m_})
        each->assign(count + 1, 0.0);
    tension_N_.assign(count + 1, numbers.pretension_N);
    spring_m_.assign(count + 1, spacing_m_);
    spring_m_.front() = spring_m_.back() = 0.5 * spacing_m_;
    sheath_m_per_N_.front() = effects.motor_sheath_m_per_N;
    sheath_m_per_N_.back() = effects.load_sheath_m_per_N;

    const TrueLocalBend& bend = effects.local_bend;
    const bool bent_here =
        bend.cables == BentCable::both || (bend.cables == BentCable::b) == numbers.is_cable_b;
    for (std::size_t i = 0; i < count; ++i) {
        const double from_m = static_cast<double>(i) * spacing_m_;
        const double to_m = from_m + spacing_m_;
        still_wrap_rad_[i] = wrap_between(numbers.curvature, from_m, to_m);
        if (bent_here) still_wrap_rad_[i] += bend.angle_rad * fraction_between(bend.where, from_m, to_m);
        moving_wrap_rad_[i] = effects.moving_bend.angle_per_load_angle *
                              fraction_between(effects.moving_bend.where, from_m, to_m);
    }
    follows_friction_ = effects.moving_bend.angle_per_load_angle != 0.0 ||
                        effects.stribeck.extra_friction != 0.0 || effects.load_dependence.exponent != 1.0 ||
                        effects.saturating_contact.weight != 0.0 || effects.heating.gain != 0.0;
    if (effects.slip_elements.length_m > 0.0) slip_.assign(slip_element_count * count, 0.0);
    constant_hold_m_per_s_ = effects.constant_drag_N_per_m * spacing_m_ * speed_per_N_;
    viscous_factor_ = 1.0 / (1.0 + effects.viscous_drag_N_s_per_m2 * spacing_m_ * speed_per_N_);
    update_stiffness();
    update_friction(0.0, 0.0);
}

double LumpedCable::stable_time_step_s(const LumpedCableNumbers& numbers, int masses) {
    const double spacing_m = length_of(numbers.curvature) / masses;
    const double wave_m_per_s = std::sqrt(numbers.axial_stiffness_N / numbers.mass_kg_per_m);
    constexpr double margin = 0.6;  // damping and stiff ends ask for some
    return margin * spacing_m / wave_m_per_s;
}

void LumpedCable::update_stiffness() {
    for (std::size_t j = 0; j < spring_N_per_m_.size(); ++j)
        spring_N_per_m_[j] =
            1.0 / (spring_m_[j] / (stiffness_ratio_ * numbers_.axial_stiffness_N) + sheath_m_per_N_[j]);
}

CAPSTAN_WIDE void LumpedCable::stretch_springs(const CableEnds& ends) {
    const std::size_t last = position_m_.size();
    const double* const u = position_m_.data();
    const double* const v = speed_m_per_s_.data();
    const double* const k = spring_N_per_m_.data();
    const double* const crept = crept_m_.data();
    double* const relaxed = relaxed_m_.data();
    double* const tension = tension_N_.data();
    const double rest_N = slow_pretension_N_;
    const double damping_s = numbers_.damping_s;
    const double branch = numbers_.loss_stiffness_ratio;
    const double forgets = time_step_s_ / numbers_.loss_time_s;
    const auto pull_N = [=](std::size_t j, double stretch_m, double rate_m_per_s) {
        const double remembered_m = stretch_m - relaxed[j];
        const double force_N =
            rest_N + k[j] * (stretch_m - crept[j] + branch * remembered_m + damping_s * rate_m_per_s);
        relaxed[j] += forgets * remembered_m;
        return force_N > 0.0 ? force_N : 0.0;
    };
    for (std::size_t j = 1; j < last; ++j) tension[j] = pull_N(j, u[j] - u[j - 1], v[j] - v[j - 1]);
    tension[0] = pull_N(0, u[0] - ends.motor_m, v[0] - ends.motor_m_per_s);
    tension[last] = pull_N(last, ends.load_m - u[last - 1], ends.load_m_per_s - v[last - 1]);
}

double LumpedCable::toe_strain(double tension_N) const {
    return effects_.toe.strain * tension_N / (tension_N + effects_.toe.tension_N);
}

// strain l = T / k + toe l T / (T + T_toe) is a quadratic in T.
void LumpedCable::stretch_springs_with_toe(const CableEnds& ends) {
    const std::size_t last = position_m_.size();
    const double toe_N = effects_.toe.tension_N;
    const double toe = effects_.toe.strain;
    const double rest_N = slow_pretension_N_;
    const double rest_toe = toe_strain(rest_N);
    const double* const u = position_m_.data();
    const double* const v = speed_m_per_s_.data();
    const double* const k = spring_N_per_m_.data();
    const double* const length = spring_m_.data();
    const double* const crept = crept_m_.data();
    double* const tension = tension_N_.data();
    double* const relaxed = relaxed_m_.data();
    const double damping_s = numbers_.damping_s;
    const double branch = numbers_.loss_stiffness_ratio;
    const double forgets = time_step_s_ / numbers_.loss_time_s;
    const auto pull_N = [=](std::size_t j, double stretch_m, double rate_m_per_s) {
        const double remembered_m = stretch_m - relaxed[j];
        const double linear_N = rest_N + k[j] * (stretch_m - crept[j] + length[j] * rest_toe +
                                                 branch * remembered_m + damping_s * rate_m_per_s);
        relaxed[j] += forgets * remembered_m;
        const double half = 0.5 * (toe_N + k[j] * length[j] * toe - linear_N);
        const double inside = half * half + toe_N * linear_N;
        const double root_N = std::sqrt(inside > 0.0 ? inside : 0.0) - half;
        return linear_N > 0.0 && root_N > 0.0 ? root_N : 0.0;
    };
    for (std::size_t j = 1; j < last; ++j) tension[j] = pull_N(j, u[j] - u[j - 1], v[j] - v[j - 1]);
    tension[0] = pull_N(0, u[0] - ends.motor_m, v[0] - ends.motor_m_per_s);
    tension[last] = pull_N(last, ends.load_m - u[last - 1], ends.load_m_per_s - v[last - 1]);
}

CAPSTAN_WIDE void LumpedCable::move_masses() {
    const std::size_t count = position_m_.size();
    double* const u = position_m_.data();
    double* const v = speed_m_per_s_.data();
    const double* const tension = tension_N_.data();
    const double* const sliding = hold_sliding_.data();
    const double* const at_rest = hold_static_.data();
    const double per_N = speed_per_N_;
    const double constant = constant_hold_m_per_s_;
    const double viscous = viscous_factor_;
    const double dt = time_step_s_;
    for (std::size_t i = 0; i < count; ++i) {
        const double coefficient = v[i] == 0.0 ? at_rest[i] : sliding[i];
        const double hold = coefficient * (tension[i] + tension[i + 1]) + constant;
        const double free = v[i] + per_N * (tension[i + 1] - tension[i]);
        const double below = free < hold ? free : hold;
        const double taken = below > -hold ? below : -hold;
        v[i] = viscous * (free - taken);
        u[i] += dt * v[i];
    }
}

void LumpedCable::move_masses_one_way() {
    const double more = 1.0 + effects_.one_way_friction;
    const double less = 1.0 - effects_.one_way_friction;
    for (std::size_t i = 0; i < position_m_.size(); ++i) {
        double& speed = speed_m_per_s_[i];
        const double free = speed + speed_per_N_ * (tension_N_[i + 1] - tension_N_[i]);
        const double coefficient = speed == 0.0 ? hold_static_[i] : hold_sliding_[i];
        const double hold = coefficient * (tension_N_[i] + tension_N_[i + 1]) * (free > 0.0 ? more : less) +
                            constant_hold_m_per_s_;
        speed = viscous_factor_ * (free - std::clamp(free, -hold, hold));
        position_m_[i] += time_step_s_ * speed;
    }
}

// Below what has two compiled forms: clang takes no such form after a call.
void LumpedCable::step(const CableEnds& ends) {
    if (effects_.toe.strain != 0.0) {
        stretch_springs_with_toe(ends);
    } else {
        stretch_springs(ends);
    }
    if (effects_.bristles.length_m > 0.0) {
        move_masses_on_bristles();
    } else if (effects_.slip_elements.length_m > 0.0) {
        move_masses_on_slip_elements();
    } else if (effects_.one_way_friction != 0.0) {
        move_masses_one_way();
    } else {
        move_masses();
    }
}

double LumpedCable::tension_N(double position_m) const {
    const double place = std::clamp(position_m / spacing_m_, 0.0, static_cast<double>(masses_));
    const auto below = std::min(static_cast<std::size_t>(place), position_m_.size() - 1);
    const double fraction = place - static_cast<double>(below);
    return (1.0 - fraction) * tension_N_[below] + fraction * tension_N_[below + 1];
}

double LumpedCable::energy_J(const CableEnds& ends) const {
    const double mass_kg = numbers_.mass_kg_per_m * spacing_m_;
    double energy_J = 0.0;
    for (const double speed : speed_m_per_s_) energy_J += 0.5 * mass_kg * speed * speed;
    for (std::size_t j = 0; j < spring_m_.size(); ++j) {
        const double from_m = j == 0 ? ends.motor_m : position_m_[j - 1];
        const double to_m = j == position_m_.size() ? ends.load_m : position_m_[j];
        const double stretch_m = to_m - from_m;
        energy_J += 0.5 * spring_N_per_m_[j] * stretch_m * stretch_m + numbers_.pretension_N * stretch_m;
    }
    return energy_J;
}

}  // namespace capstan::gap_trial
