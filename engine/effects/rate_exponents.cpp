#include "capstan/effects/rate_exponents.h"

#include <algorithm>
#include <cmath>

namespace capstan {

namespace {

// A segment without tension presses on nothing: the drag counts as no more than this exponent.
constexpr double max_drag_exponent = 1.0;
// More drag never makes the cable faster; this limits how much slower it can be thought to make it.
constexpr double min_response = -100.0;

}  // namespace

RateExponents::RateExponents(const RateFriction& friction, std::span<const double> relative_length,
                             double segment_m, double interval_s, std::size_t cables)
    : friction_(friction),
      interval_s_(interval_s),
      drag_N_s_per_m_(interval_s * laws::sliding_drag_N_per_m(friction.viscous, segment_m, interval_s)),
      cables_(cables),
      relative_length_(relative_length.begin(), relative_length.end()),
      response_(cables, 0.0) {
    for (auto* rows :
         {&lagging_m_per_s_, &speed_m_per_s_, &tension_N_, &drag_N_, &last_drag_N_, &last_found_N_})
        rows->assign(cables * relative_length.size(), 0.0);
}

void RateExponents::observe(std::size_t k, double tension_N, double slid_m) {
    tension_N_[k] = tension_N;
    speed_m_per_s_[k] = std::abs(slid_m) / interval_s_;
}

// E41.
double RateExponents::with_speed(std::size_t k, double exponent, double wrap_rad) const {
    if (friction_.stribeck.is_active() && wrap_rad > 0.0)
        exponent += wrap_rad * laws::added_friction(friction_.stribeck, lagging_m_per_s_[k]);
    if (drag_N_[k] > 0.0)
        exponent +=
            drag_N_[k] < max_drag_exponent * tension_N_[k] ? drag_N_[k] / tension_N_[k] : max_drag_exponent;
    return exponent;
}

void RateExponents::end_step() {
    if (needs_second_trial()) {
        learn_response();
        put_drag_right();
    }
    for (std::size_t k = 0; k < speed_m_per_s_.size(); ++k)
        lagging_m_per_s_[k] =
            laws::lagging_speed(friction_.stribeck, lagging_m_per_s_[k], speed_m_per_s_[k], interval_s_);
}

// Two trials of a step tell, for each cable, how the drag found follows the one assumed.
void RateExponents::learn_response() {
    for (std::size_t j = 0; j < cables_; ++j) {
        double cross = 0.0;
        double squares = 0.0;
        for (std::size_t k = j; k < drag_N_.size(); k += cables_) {
            const double assumed_N = drag_N_[k] - last_drag_N_[k];
            cross += assumed_N * (found_drag_N(k) - last_found_N_[k]);
            squares += assumed_N * assumed_N;
        }
        if (squares > 0.0) response_[j] = std::clamp(cross / squares, min_response, 0.0);
    }
}

// The drag that the next trial would find if it followed the one assumed so.
void RateExponents::put_drag_right() {
    for (std::size_t k = 0; k < drag_N_.size(); ++k) {
        const double found_N = found_drag_N(k);
        last_drag_N_[k] = drag_N_[k];
        last_found_N_[k] = found_N;
        drag_N_[k] = std::max(drag_N_[k] + (found_N - drag_N_[k]) / (1.0 - response_[k % cables_]), 0.0);
    }
}

}  // namespace capstan
