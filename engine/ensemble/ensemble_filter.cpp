#include "capstan/ensemble/ensemble_filter.h"

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"
#include "capstan/ensemble/ensemble_rows.h"

namespace capstan {

namespace {

std::vector<double> spread(double centre, double deviation, std::span<const double> normals) {
    std::vector<double> row(normals.begin(), normals.end());
    for (double& each : row) each = centre + deviation * each;
    return row;
}

// Static friction beyond the friction that depends on speed is left out, as on the bench (E18).
Cable nominal_cable(CableSpecification nominal, const RateFriction& friction) {
    if (friction.is_active()) nominal.static_friction = nominal.dynamic_friction;
    return Cable(nominal);
}

}  // namespace

EnsembleFilter::EnsembleFilter(const UncertainCable& cable, const CableBelief& belief,
                               std::span<const SensorOffer> offers, std::span<const int> sensors,
                               const EnsembleDraws& draws)
    : cable_(cable),
      draws_(draws),
      members_(nominal_cable(cable.nominal(), belief.rate_friction), draws.members()),
      support_(belief.support),
      far_end_(belief.far_end, belief.interval_s),
      nominal_compliance_m_per_N_(Cable(cable.nominal()).segment_compliance_m_per_N()),
      nominal_pretension_N_(cable.nominal().pretension_N) {
    begin(belief, offers, sensors);
}

void EnsembleFilter::begin(const CableBelief& belief, std::span<const SensorOffer> offers,
                           std::span<const int> sensors) {
    const auto count = static_cast<std::size_t>(members_.members());
    const CableUncertainty& unknown = belief.uncertainty;
    log_friction_ = spread(belief.expected.log_friction, unknown.friction, draws_.parameter(0));
    log_stiffness_ = spread(belief.expected.log_stiffness, unknown.stiffness, draws_.parameter(1));
    log_pretension_ = spread(belief.expected.log_pretension, unknown.pretension, draws_.parameter(2));
    for (int bend = 0; bend < cable_.bends(); ++bend) {
        const auto b = static_cast<std::size_t>(bend);
        const double expected = b < belief.expected.log_wrap.size() ? belief.expected.log_wrap[b] : 0.0;
        log_wrap_.push_back(spread(expected, unknown.wrap, draws_.parameter(3 + bend)));
    }
    far_end_m_.assign(count, 0.0);
    far_end_m_per_s_.assign(count, 0.0);
    for (auto* row : {&distal_value_, &sensed_, &pull_, &tension_pull_, &friction_, &pretension_N_})
        row->assign(count, 0.0);
    mean_N_.assign(static_cast<std::size_t>(members_.nodes()), 0.0);
    deviation_N_ = mean_N_;

    const Cable cable(cable_.nominal());
    for (const int index : sensors) {
        const SensorOffer& offer = offers[static_cast<std::size_t>(index)];
        if (!(offer.place_m >= 0.0) || offer.place_m > cable.length_m() * (1.0 + 1e-9))
            throw InvalidInput({"ensemble filter: a sensor at " + std::to_string(offer.place_m) +
                                " m is beyond the cable, which is " + std::to_string(cable.length_m()) +
                                " m long"});
        sensors_.push_back({offer, spot_at(cable, offer.place_m),
                            spread(0.0, offer.errors.zero, draws_.zero(index)),
                            spread(0.0, offer.errors.gain_ratio, draws_.gain(index))});
    }

    if (belief.rate_friction.is_active()) {
        rate_step_.emplace(belief.rate_friction, members_, cable.segment_length_m(), belief.interval_s);
        wrap_rad_.assign(count * static_cast<std::size_t>(members_.segments()), 0.0);
    }
    take_parameters();
    for (int member = 0; member < members_.members(); ++member) {
        const double tension_N = pretension_N_[static_cast<std::size_t>(member)];
        for (int node = 0; node < members_.nodes(); ++node) members_.tension_N(node)[member] = tension_N;
    }
    take_displacements();
    take_moments();
}

void EnsembleFilter::step(double proximal_increment_m, std::span<const double> readings) {
    bool finite = std::isfinite(proximal_increment_m);
    for (const double reading : readings) finite = finite && std::isfinite(reading);
    if (!finite) throw InvalidInput({"ensemble filter: an input of this step is not a finite number"});
    if (sample_ >= draws_.samples()) throw InvalidInput({"ensemble filter: a step after the last sample"});
    move_far_end();
    const EnsembleReport report = advance(proximal_increment_m);
    report_.searched += report.searched;
    report_.unverified += report.unverified;
    for (std::size_t s = 0; s < sensors_.size(); ++s) correct(sensors_[s], readings[s]);
    if (!sensors_.empty()) {
        keep_tensions_positive();
        take_parameters();
        take_displacements();
    }
    take_moments();
    ++sample_;
}

EnsembleReport EnsembleFilter::advance(double proximal_increment_m) {
    const double stiffness = support_.spring_stiffness_N_per_m;
    const CableEnsemble::DistalEnd distal = stiffness > 0.0
                                                ? CableEnsemble::DistalEnd{stiffness, 1.0, distal_value_}
                                                : CableEnsemble::DistalEnd{1.0, 0.0, distal_value_};
    return rate_step_ ? rate_step_->advance(members_, wrap_rad_, proximal_increment_m, distal)
                      : members_.advance(proximal_increment_m, distal);
}

// E40; then E6 of the distal end.
void EnsembleFilter::move_far_end() {
    const auto first = draws_.first(sample_);
    const auto second = draws_.second(sample_);
    const double stiffness = support_.spring_stiffness_N_per_m;
    for (std::size_t j = 0; j < far_end_m_.size(); ++j) {
        if (far_end_.moves()) far_end_.advance(far_end_m_[j], far_end_m_per_s_[j], first[j], second[j]);
        distal_value_[j] = stiffness > 0.0 ? pretension_N_[j] + stiffness * far_end_m_[j] : far_end_m_[j];
    }
}

double EnsembleFilter::sensed(const Fitted& sensor, int member) const {
    const auto j = static_cast<std::size_t>(member);
    double value = 0.0;
    if (measures_tension(sensor.offer.kind)) {
        const SensorSpot& spot = sensor.spot;
        value = (1.0 - spot.fraction) * members_.tension_N(spot.node)[j] +
                spot.fraction * members_.tension_N(spot.node + 1)[j];
    } else {
        value = far_end_m_[j];
        const double stiffness = support_.spring_stiffness_N_per_m;
        if (stiffness > 0.0) value += (pretension_N_[j] - distal_tension_N(member)) / stiffness;
    }
    return value * (1.0 + sensor.gain[j]) + sensor.zero[j];
}

// E37 for one reading, over the state and all parameters.
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
        tension_pull_[j] = members_.is_slack(static_cast<int>(j)) ? 0.0 : pull_[j];
    }
    const double degrees = static_cast<double>(count) - 1.0;
    RowCorrection correction{sensed_, tension_pull_, variance * degrees, total * degrees, chance_variances};
    corrected_.clear();
    for (int node = 0; node < members_.nodes(); ++node) corrected_.push_back(members_.tension_N(node).data());
    correct_rows(correction, corrected_);
    correction.pull = pull_;
    corrected_.clear();
    for (auto* row : {&log_friction_, &log_stiffness_, &log_pretension_, &far_end_m_, &far_end_m_per_s_})
        corrected_.push_back(row->data());
    for (auto& row : log_wrap_) corrected_.push_back(row.data());
    for (Fitted& each : sensors_) {
        if (each.offer.errors.zero > 0.0) corrected_.push_back(each.zero.data());
        if (each.offer.errors.gain_ratio > 0.0) corrected_.push_back(each.gain.data());
    }
    correct_rows(correction, corrected_);
}

// No cable pushes.
void EnsembleFilter::keep_tensions_positive() {
    std::vector<double>& highest = pull_;
    std::fill(highest.begin(), highest.end(), 0.0);
    for (int node = 0; node < members_.nodes(); ++node) {
        const auto row = members_.tension_N(node);
        for (std::size_t j = 0; j < row.size(); ++j) {
            row[j] = std::max(row[j], 0.0);
            highest[j] = std::max(highest[j], row[j]);
        }
    }
    for (std::size_t j = 0; j < highest.size(); ++j)
        if (!(highest[j] > 0.0) && !members_.is_slack(static_cast<int>(j)))
            members_.make_slack(static_cast<int>(j));
}

void EnsembleFilter::take_parameters() {
    const auto compliance = members_.compliance_m_per_N();
    exp_row(log_stiffness_, pull_);
    for (std::size_t j = 0; j < compliance.size(); ++j)
        compliance[j] = nominal_compliance_m_per_N_ / pull_[j];
    exp_row(log_pretension_, pretension_N_);
    for (double& each : pretension_N_) each *= nominal_pretension_N_;
    exp_row(log_friction_, friction_);
    for (int segment = 0; segment < members_.segments(); ++segment) {
        const auto exponent = members_.sliding_exponent(segment);
        std::fill(exponent.begin(), exponent.end(), 0.0);
    }
    std::fill(wrap_rad_.begin(), wrap_rad_.end(), 0.0);
    const double friction = cable_.nominal().dynamic_friction;
    for (int bend = 0; bend < cable_.bends(); ++bend) {
        exp_row(log_wrap_[static_cast<std::size_t>(bend)], pull_);
        add_wrap(bend, pull_);
        for (std::size_t j = 0; j < pull_.size(); ++j) pull_[j] *= friction * friction_[j];
        for (int segment = 0; segment < members_.segments(); ++segment) {
            const double wrap_rad = cable_.wrap_of_bend_rad(bend)[static_cast<std::size_t>(segment)];
            if (wrap_rad == 0.0) continue;
            const auto exponent = members_.sliding_exponent(segment);
            for (std::size_t j = 0; j < exponent.size(); ++j) exponent[j] += wrap_rad * pull_[j];
        }
    }
    members_.retune();
}

// Of friction that depends on speed, which needs the wrap itself.
void EnsembleFilter::add_wrap(int bend, std::span<const double> factor) {
    const std::vector<double>& nominal_rad = cable_.wrap_of_bend_rad(bend);
    for (std::size_t k = 0; k < wrap_rad_.size(); ++k)
        wrap_rad_[k] += nominal_rad[k / factor.size()] * factor[k % factor.size()];
}

// E2 with the mean of both nodes' tensions, back from where the distal end is.
void EnsembleFilter::take_displacements() {
    const int last = members_.segments();
    const double stiffness = support_.spring_stiffness_N_per_m;
    const auto compliance = members_.compliance_m_per_N();
    const auto distal_m = members_.displacement_m(last);
    const auto distal_N = members_.tension_N(last);
    for (std::size_t j = 0; j < distal_m.size(); ++j) {
        if (members_.is_slack(static_cast<int>(j))) continue;
        distal_m[j] = far_end_m_[j];
        if (stiffness > 0.0) distal_m[j] += (pretension_N_[j] - distal_N[j]) / stiffness;
    }
    for (int node = last - 1; node >= 0; --node) {
        const auto here_m = members_.displacement_m(node);
        const auto next_m = members_.displacement_m(node + 1);
        const auto here_N = members_.tension_N(node);
        const auto next_N = members_.tension_N(node + 1);
        for (std::size_t j = 0; j < here_m.size(); ++j) {
            if (members_.is_slack(static_cast<int>(j))) continue;
            here_m[j] = next_m[j] - 0.5 * compliance[j] * (here_N[j] + next_N[j]);
        }
    }
}

void EnsembleFilter::take_moments() {
    for (int node = 0; node < members_.nodes(); ++node) {
        const RowMoments moments = moments_of_row(members_.tension_N(node));
        mean_N_[static_cast<std::size_t>(node)] = moments.mean;
        deviation_N_[static_cast<std::size_t>(node)] = moments.deviation;
    }
}

RowMoments EnsembleFilter::log_friction() const {
    return moments_of_row(log_friction_);
}

RowMoments EnsembleFilter::far_end_m() const {
    return moments_of_row(far_end_m_);
}

}  // namespace capstan
