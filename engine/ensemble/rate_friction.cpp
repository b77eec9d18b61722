#include "capstan/ensemble/rate_friction.h"

#include <algorithm>
#include <cmath>

namespace capstan {

namespace {

// A segment without tension presses on nothing: the drag counts as no more than this exponent.
constexpr double max_drag_exponent = 1.0;
// More drag never makes the cable faster; this limits how much slower it can be thought to make it.
constexpr double min_response = -100.0;

}  // namespace

RateFrictionStep::RateFrictionStep(const RateFriction& friction, const CableEnsemble& members,
                                   double segment_m, double interval_s)
    : friction_(friction),
      interval_s_(interval_s),
      drag_N_s_per_m_(interval_s * laws::sliding_drag_N_per_m(friction.viscous, segment_m, interval_s)),
      count_(static_cast<std::size_t>(members.members())),
      before_(members),
      response_(count_, 0.0) {
    for (auto* rows : {&exponent_, &lagging_m_per_s_, &speed_m_per_s_, &tension_N_, &drag_N_, &last_drag_N_,
                       &last_found_N_})
        rows->assign(count_ * static_cast<std::size_t>(members.segments()), 0.0);
}

EnsembleReport RateFrictionStep::advance(CableEnsemble& members, std::span<const double> wrap_rad,
                                         double proximal_increment_m,
                                         const CableEnsemble::DistalEnd& distal) {
    for (int segment = 0; segment < members.segments(); ++segment) {
        const auto exponent = members.sliding_exponent(segment);
        std::copy(exponent.begin(), exponent.end(), exponent_.data() + segment * count_);
    }
    before_ = members;
    observe(members);
    set_exponents(members, wrap_rad);
    EnsembleReport report = members.advance(proximal_increment_m, distal);
    observe(members);
    if (friction_.viscous.is_active()) {
        put_drag_right();
        members = before_;
        set_exponents(members, wrap_rad);
        report = members.advance(proximal_increment_m, distal);
        observe(members);
        learn_response();
        put_drag_right();
    }
    for (std::size_t k = 0; k < speed_m_per_s_.size(); ++k)
        lagging_m_per_s_[k] =
            laws::lagging_speed(friction_.stribeck, lagging_m_per_s_[k], speed_m_per_s_[k], interval_s_);
    for (int segment = 0; segment < members.segments(); ++segment) {
        const double* from = exponent_.data() + segment * count_;
        std::copy(from, from + count_, members.sliding_exponent(segment).begin());
    }
    return report;
}

// E41.
void RateFrictionStep::set_exponents(CableEnsemble& members, std::span<const double> wrap_rad) const {
    for (int segment = 0; segment < members.segments(); ++segment) {
        const auto exponent = members.sliding_exponent(segment);
        for (std::size_t j = 0; j < count_; ++j) {
            const std::size_t k = segment * count_ + j;
            exponent[j] = exponent_[k];
            if (friction_.stribeck.is_active() && wrap_rad[k] > 0.0)
                exponent[j] += wrap_rad[k] * laws::added_friction(friction_.stribeck, lagging_m_per_s_[k]);
            if (drag_N_[k] > 0.0)
                exponent[j] += drag_N_[k] < max_drag_exponent * tension_N_[k] ? drag_N_[k] / tension_N_[k]
                                                                              : max_drag_exponent;
        }
    }
    members.retune();
}

// Tension, and speed since `before_`, of each segment.
void RateFrictionStep::observe(const CableEnsemble& members) {
    for (int segment = 0; segment < members.segments(); ++segment) {
        const auto near_N = members.tension_N(segment);
        const auto far_N = members.tension_N(segment + 1);
        const auto near_m = members.displacement_m(segment);
        const auto far_m = members.displacement_m(segment + 1);
        const auto near_before_m = before_.displacement_m(segment);
        const auto far_before_m = before_.displacement_m(segment + 1);
        for (std::size_t j = 0; j < count_; ++j) {
            const std::size_t k = segment * count_ + j;
            tension_N_[k] = 0.5 * (near_N[j] + far_N[j]);
            const double slid_m = 0.5 * (near_m[j] - near_before_m[j] + far_m[j] - far_before_m[j]);
            const bool is_slack = members.is_slack(static_cast<int>(j));
            speed_m_per_s_[k] = is_slack ? 0.0 : std::abs(slid_m) / interval_s_;
        }
    }
}

// Two trials of a step tell, for each member, how the drag found follows the one assumed.
void RateFrictionStep::learn_response() {
    for (std::size_t j = 0; j < count_; ++j) {
        double cross = 0.0;
        double squares = 0.0;
        for (std::size_t k = j; k < drag_N_.size(); k += count_) {
            const double assumed_N = drag_N_[k] - last_drag_N_[k];
            cross += assumed_N * (found_drag_N(k) - last_found_N_[k]);
            squares += assumed_N * assumed_N;
        }
        if (squares > 0.0) response_[j] = std::clamp(cross / squares, min_response, 0.0);
    }
}

// The drag that the next trial would find if it followed the one assumed so.
void RateFrictionStep::put_drag_right() {
    for (std::size_t k = 0; k < drag_N_.size(); ++k) {
        const double found_N = found_drag_N(k);
        last_drag_N_[k] = drag_N_[k];
        last_found_N_[k] = found_N;
        drag_N_[k] = std::max(drag_N_[k] + (found_N - drag_N_[k]) / (1.0 - response_[k % count_]), 0.0);
    }
}

}  // namespace capstan
