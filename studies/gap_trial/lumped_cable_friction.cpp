#include <algorithm>
#include <array>
#include <cmath>

#include "capstan/gap_trial/lumped_cable.h"

namespace capstan::gap_trial {

namespace {

// Of the elastic-plastic elements, in their effect's lengths.
constexpr std::array<double, LumpedCable::slip_element_count> yields_after = {0.3, 0.7, 1.2, 2.0};

double stribeck_fraction(const TrueStribeck& law, double speed_m_per_s) {
    const double ratio = std::abs(speed_m_per_s) / law.speed_m_per_s;
    return law.power == 0.0 ? std::exp(-ratio) : 1.0 / (1.0 + std::pow(ratio, law.power));
}

}  // namespace

void LumpedCable::move_masses_on_bristles() {
    const std::size_t count = position_m_.size();
    double* const u = position_m_.data();
    double* const v = speed_m_per_s_.data();
    double* const bristle = bristle_.data();
    const double* const tension = tension_N_.data();
    const double* const sliding = hold_sliding_.data();
    const double softness = effects_.bristles.softness;
    const double bend_per_m_per_s = time_step_s_ / effects_.bristles.length_m;
    // A thousandth of full friction where the bristles bend by their length in 20 ms: LuGre's own damping.
    const double bristle_damping_s = 2e-5;
    for (std::size_t i = 0; i < count; ++i) {
        const double full = sliding[i] * (tension[i] + tension[i + 1]) + constant_hold_m_per_s_;
        const double way = v[i] < 0.0 ? -1.0 : 1.0;
        const double y = bristle[i] * way;
        const double bend = bend_per_m_per_s * v[i] * (1.0 - y * (1.0 - softness + softness * y));
        bristle[i] += bend;
        const double drag = full * (bristle[i] + bristle_damping_s / time_step_s_ * bend);
        v[i] = viscous_factor_ * (v[i] + speed_per_N_ * (tension[i + 1] - tension[i]) - drag);
        u[i] += time_step_s_ * v[i];
    }
}

void LumpedCable::move_masses_on_slip_elements() {
    const std::size_t count = position_m_.size();
    double* const u = position_m_.data();
    double* const v = speed_m_per_s_.data();
    const double* const tension = tension_N_.data();
    const double* const sliding = hold_sliding_.data();
    constexpr double fraction = 1.0 / slip_element_count;
    for (std::size_t i = 0; i < count; ++i) {
        const double full = sliding[i] * (tension[i] + tension[i + 1]) + constant_hold_m_per_s_;
        double* const slip = slip_.data() + slip_element_count * i;
        double held = 0.0;
        for (std::size_t k = 0; k < slip_element_count; ++k) {
            const double bent =
                slip[k] + time_step_s_ * v[i] / (yields_after[k] * effects_.slip_elements.length_m);
            const double below = bent < 1.0 ? bent : 1.0;
            slip[k] = below > -1.0 ? below : -1.0;
            held += slip[k];
        }
        v[i] =
            viscous_factor_ * (v[i] + speed_per_N_ * (tension[i + 1] - tension[i]) - full * fraction * held);
        u[i] += time_step_s_ * v[i];
    }
}

void LumpedCable::follow(double load_angle_rad, double session_time_s, double elapsed_s) {
    update_pretension(session_time_s);
    if (effects_.creep.ratio != 0.0) update_creep(elapsed_s);
    if (follows_friction_) update_friction(load_angle_rad, elapsed_s);
}

void LumpedCable::update_pretension(double session_time_s) {
    const StrandBreak& strands = effects_.strand_break;
    if (strands.fraction != 0.0 && !numbers_.is_cable_b && stiffness_ratio_ == 1.0 &&
        session_time_s >= strands.session_time_s) {
        stiffness_ratio_ = 1.0 - strands.fraction;
        // The lab sets the pretension of a run that begins with what is left.
        if (numbers_.session_start_s < strands.session_time_s) strands_kept_in_run_ = stiffness_ratio_;
        update_stiffness();
    }
    double kept = strands_kept_in_run_;
    if (effects_.drift.lost != 0.0)
        kept *= 1.0 + effects_.drift.lost * std::expm1(-session_time_s / effects_.drift.time_s);
    if (effects_.dip.fraction != 0.0) {
        const double off = (session_time_s - effects_.dip.session_time_s) / effects_.dip.width_s;
        kept *= 1.0 - effects_.dip.fraction * std::exp(-off * off);
    }
    slow_pretension_N_ = numbers_.pretension_N * kept;
}

void LumpedCable::update_creep(double elapsed_s) {
    const double fast = elapsed_s / effects_.creep.time_constant_s;
    const double slow = fast / effects_.creep.slow_factor;
    const double fast_fraction = effects_.creep.fast_fraction;
    const double ratio = effects_.creep.ratio / numbers_.axial_stiffness_N;
    for (std::size_t j = 0; j < crept_m_.size(); ++j) {
        const double final_m = ratio * spring_m_[j] * (tension_N_[j] - numbers_.pretension_N);
        crept_fast_m_[j] += fast * (fast_fraction * final_m - crept_fast_m_[j]);
        crept_slow_m_[j] += slow * ((1.0 - fast_fraction) * final_m - crept_slow_m_[j]);
        crept_m_[j] = crept_fast_m_[j] + crept_slow_m_[j];
    }
}

void LumpedCable::update_friction(double load_angle_rad, double elapsed_s) {
    const TrueStribeck& stribeck = effects_.stribeck;
    const TrueLoadDependence& load = effects_.load_dependence;
    const TrueSaturatingContact& contact = effects_.saturating_contact;
    const FrictionalHeating& heating = effects_.heating;
    for (std::size_t i = 0; i < hold_sliding_.size(); ++i) {
        const double wrap_rad = std::max(0.0, still_wrap_rad_[i] + moving_wrap_rad_[i] * load_angle_rad);
        const double tension_N = 0.5 * (tension_N_[i] + tension_N_[i + 1]);
        double sliding = numbers_.dynamic_friction;
        double factor = 1.0;
        if (stribeck.extra_friction != 0.0) {
            slow_speed_m_per_s_[i] +=
                elapsed_s / stribeck.memory_s * (speed_m_per_s_[i] - slow_speed_m_per_s_[i]);
            sliding += stribeck.extra_friction * stribeck_fraction(stribeck, slow_speed_m_per_s_[i]);
        }
        if (load.exponent != 1.0) {
            const double normal = tension_N * wrap_rad / spacing_m_ / load.reference_N_per_m;
            factor *= std::pow(std::clamp(normal, 0.05, 20.0), load.exponent - 1.0);
        }
        if (contact.weight != 0.0) {
            const double normal = tension_N * wrap_rad / spacing_m_ / contact.reference_N_per_m;
            factor *= 1.0 + contact.weight * (1.0 - normal) / (1.0 + normal);
        }
        if (heating.gain != 0.0) {
            const double power_W_per_m =
                sliding * tension_N * wrap_rad / spacing_m_ * std::abs(speed_m_per_s_[i]);
            warmth_[i] += elapsed_s * (power_W_per_m / heating.heat_J_per_m - warmth_[i] / heating.cooling_s);
            factor *= std::max(0.1, 1.0 + heating.gain * warmth_[i]);
        }
        // Half, because the chain adds the tensions on a mass's two sides.
        const double per_coefficient = 0.5 * wrap_rad * speed_per_N_ * factor;
        hold_sliding_[i] = sliding * per_coefficient;
        hold_static_[i] = std::max(sliding, numbers_.static_friction) * per_coefficient;
    }
}

}  // namespace capstan::gap_trial
