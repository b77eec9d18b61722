#include "capstan/ensemble/rate_friction.h"

#include <algorithm>

namespace capstan {

RateFrictionStep::RateFrictionStep(const RateFriction& friction, const CableEnsemble& members,
                                   double segment_m, double interval_s)
    : count_(static_cast<std::size_t>(members.members())),
      before_(members),
      rates_(friction, members.relative_length(), segment_m, interval_s, count_),
      exponent_(rates_.size(), 0.0) {}

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
    if (rates_.needs_second_trial()) {
        rates_.end_first_trial();
        members = before_;
        set_exponents(members, wrap_rad);
        report = members.advance(proximal_increment_m, distal);
        observe(members);
    }
    rates_.end_step();
    for (int segment = 0; segment < members.segments(); ++segment) {
        const double* from = exponent_.data() + segment * count_;
        std::copy(from, from + count_, members.sliding_exponent(segment).begin());
    }
    return report;
}

void RateFrictionStep::set_exponents(CableEnsemble& members, std::span<const double> wrap_rad) const {
    for (int segment = 0; segment < members.segments(); ++segment) {
        const auto exponent = members.sliding_exponent(segment);
        for (std::size_t j = 0; j < count_; ++j) {
            const std::size_t k = segment * count_ + j;
            exponent[j] = rates_.with_speed(k, exponent_[k], wrap_rad[k]);
        }
    }
    members.retune();
}

// Tension, and how far each segment has slid since `before_`.
void RateFrictionStep::observe(const CableEnsemble& members) {
    for (int segment = 0; segment < members.segments(); ++segment) {
        const auto near_N = members.tension_N(segment);
        const auto far_N = members.tension_N(segment + 1);
        const auto near_m = members.displacement_m(segment);
        const auto far_m = members.displacement_m(segment + 1);
        const auto near_before_m = before_.displacement_m(segment);
        const auto far_before_m = before_.displacement_m(segment + 1);
        for (std::size_t j = 0; j < count_; ++j) {
            const double slid_m = 0.5 * (near_m[j] - near_before_m[j] + far_m[j] - far_before_m[j]);
            rates_.observe(segment * count_ + j, 0.5 * (near_N[j] + far_N[j]),
                           members.is_slack(static_cast<int>(j)) ? 0.0 : slid_m);
        }
    }
}

}  // namespace capstan
