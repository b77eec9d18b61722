#include "capstan/ensemble/ensemble_filter.h"

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"

namespace capstan {

EnsembleFilter::EnsembleFilter(const UncertainCable& cable, const CableBelief& belief,
                               std::span<const SensorOffer> offers, std::span<const int> sensors,
                               const EnsembleDraws& draws)
    : draws_(draws), member_cable_(cable, belief, draws, 0), far_end_(belief.far_end, belief.interval_s) {
    const auto count = static_cast<std::size_t>(draws.members());
    for (auto* row : {&far_end_m_, &far_end_m_per_s_, &sensed_, &pull_, &tension_pull_})
        row->assign(count, 0.0);
    mean_N_.assign(static_cast<std::size_t>(member_cable_.nodes()), 0.0);
    deviation_N_ = mean_N_;
    const Cable nominal(cable.nominal());
    for (int rank = 0; rank < static_cast<int>(sensors.size()); ++rank) {
        const int index = sensors[static_cast<std::size_t>(rank)];
        const SensorOffer& offer = offers[static_cast<std::size_t>(index)];
        if (!(offer.place_m >= 0.0) || offer.place_m > nominal.length_m() * (1.0 + 1e-9))
            throw InvalidInput({"ensemble filter: a sensor at " + std::to_string(offer.place_m) +
                                " m is beyond the cable, which is " + std::to_string(nominal.length_m()) +
                                " m long"});
        sensors_.push_back({offer, spot_at(nominal, offer.place_m),
                            spread(0.0, offer.errors.zero, draws_.zero(rank)),
                            spread(0.0, offer.errors.gain_ratio, draws_.gain(rank))});
    }
    take_moments();
}

void EnsembleFilter::step(double proximal_increment_m, std::span<const double> readings) {
    bool finite = std::isfinite(proximal_increment_m);
    for (const double reading : readings) finite = finite && std::isfinite(reading);
    if (!finite) throw InvalidInput({"ensemble filter: an input of this step is not a finite number"});
    if (sample_ >= draws_.samples()) throw InvalidInput({"ensemble filter: a step after the last sample"});
    move_far_end();
    const EnsembleReport report = member_cable_.advance(proximal_increment_m, far_end_m_);
    report_.searched += report.searched;
    report_.unverified += report.unverified;
    for (std::size_t s = 0; s < sensors_.size(); ++s) correct(sensors_[s], readings[s]);
    if (!sensors_.empty()) member_cable_.settle(far_end_m_);
    take_moments();
    ++sample_;
}

// E40.
void EnsembleFilter::move_far_end() {
    if (!far_end_.moves()) return;
    const auto first = draws_.first(sample_);
    const auto second = draws_.second(sample_);
    for (std::size_t j = 0; j < far_end_m_.size(); ++j)
        far_end_.advance(far_end_m_[j], far_end_m_per_s_[j], first[j], second[j]);
}

double EnsembleFilter::sensed(const Fitted& sensor, int member) const {
    const auto j = static_cast<std::size_t>(member);
    const double value = measures_tension(sensor.offer.kind)
                             ? member_cable_.tension_N(sensor.spot, member)
                             : far_end_m_[j] + member_cable_.beyond_wall_m(member);
    return value * (1.0 + sensor.gain[j]) + sensor.zero[j];
}

// E37 for one reading, over the state and all numbers.
void EnsembleFilter::correct(Fitted& sensor, double reading) {
    const std::size_t count = sensed_.size();
    for (std::size_t j = 0; j < count; ++j) sensed_[j] = sensed(sensor, static_cast<int>(j));
    const RowMoments before = moments_of_row(sensed_);
    if (!(before.deviation > 0.0)) return;
    const double variance = before.deviation * before.deviation;
    const SensorErrors& errors = sensor.offer.errors;
    const double proportional = errors.multiplicative_ratio * before.mean;
    // A sensor without noise still has rounding: a millionth of what the members spread.
    const double noise_variance =
        std::max(proportional * proportional + errors.additive * errors.additive, 1e-12 * variance);
    const double total = variance + noise_variance;
    const double fraction = 1.0 / (1.0 + std::sqrt(noise_variance / total));
    for (std::size_t j = 0; j < count; ++j) {
        sensed_[j] -= before.mean;
        pull_[j] = reading - before.mean - fraction * sensed_[j];
        tension_pull_[j] = member_cable_.is_slack(static_cast<int>(j)) ? 0.0 : pull_[j];
    }
    const double degrees = static_cast<double>(count) - 1.0;
    RowCorrection correction{sensed_, tension_pull_, variance * degrees, total * degrees, chance_variances};
    corrected_.clear();
    member_cable_.add_tensions(corrected_);
    correct_rows(correction, corrected_);
    correction.pull = pull_;
    corrected_ = {far_end_m_.data(), far_end_m_per_s_.data()};
    member_cable_.add_numbers(corrected_);
    for (Fitted& each : sensors_) {
        if (each.offer.errors.zero > 0.0) corrected_.push_back(each.zero.data());
        if (each.offer.errors.gain_ratio > 0.0) corrected_.push_back(each.gain.data());
    }
    correct_rows(correction, corrected_);
}

void EnsembleFilter::take_moments() {
    for (int node = 0; node < member_cable_.nodes(); ++node) {
        const RowMoments moments = member_cable_.tension_moments_N(node);
        mean_N_[static_cast<std::size_t>(node)] = moments.mean;
        deviation_N_[static_cast<std::size_t>(node)] = moments.deviation;
    }
}

}  // namespace capstan
