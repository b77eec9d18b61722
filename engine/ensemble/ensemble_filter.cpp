#include "capstan/ensemble/ensemble_filter.h"

#include <algorithm>
#include <cmath>

#include "capstan/cable/invalid_input.h"

namespace capstan {

namespace {

// A slack member reads 0 however far it is from becoming taut, so where most members are slack and the cable
// is not, a reading tells them nothing and the filter loses the cable. From this many standard deviations of
// an innovation on, slack members count as if they could push.
constexpr double surprising_deviations = 5.0;

}  // namespace

EnsembleFilter::EnsembleFilter(const UncertainCable& cable, const CableBelief& belief,
                               std::span<const SensorOffer> offers, std::span<const int> sensors,
                               const EnsembleDraws& draws)
    : draws_(draws), far_end_(belief.far_end, belief.interval_s) {
    const int cables = cables_of(belief.arrangement);
    if (cables == 2 && belief.support.spring_stiffness_N_per_m > 0.0)
        throw InvalidInput(
            {"ensemble filter: a spring at the load of a pull-pull pair is not known to it; "
             "prescribe the load's motion"});
    for (int which = 0; which < cables; ++which) cables_.emplace_back(cable, belief, draws, which);
    const auto count = static_cast<std::size_t>(draws.members());
    for (auto* row : {&far_end_m_, &far_end_m_per_s_, &opposite_m_, &off_m_[0], &off_m_[1], &far_end_by_m_,
                      &sensed_, &workspace_, &taut_move_})
        row->assign(count, 0.0);
    all_move_.assign(count, 1.0);
    mean_N_.assign(static_cast<std::size_t>(cables * cables_.front().nodes()), 0.0);
    deviation_N_ = mean_N_;
    tells_sum_ = cables == 1 || std::any_of(sensors.begin(), sensors.end(), [&](int sensor) {
                     return offers[static_cast<std::size_t>(sensor)].kind == SensorKind::tension;
                 });
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
    for (std::size_t cable = 0; cable < cables_.size(); ++cable) {
        const double increment_m = cable == 0 ? proximal_increment_m : -proximal_increment_m;
        const EnsembleReport report = cables_[cable].advance(increment_m, far_end_m(cable));
        report_.searched += report.searched;
        report_.unverified += report.unverified;
    }
    for (std::size_t s = 0; s < sensors_.size(); ++s) correct(sensors_[s], readings[s]);
    if (!sensors_.empty()) {
        oppose_far_end();
        for (std::size_t cable = 0; cable < cables_.size(); ++cable) cables_[cable].settle(far_end_m(cable));
        hold_motor();
    }
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
    oppose_far_end();
}

// E15.
void EnsembleFilter::oppose_far_end() {
    for (std::size_t j = 0; j < far_end_m_.size(); ++j) opposite_m_[j] = -far_end_m_[j];
}

// E42. A reading corrects each row by its own correlation, screened against chance, so that the far end and
// the stretch of a cable no longer add up to where the motor is, which is known.
void EnsembleFilter::hold_motor() {
    const double shared_by = static_cast<double>(cables_.size()) + (far_end_.moves() ? 1.0 : 0.0);
    for (std::size_t cable = 0; cable < cables_.size(); ++cable)
        cables_[cable].find_off_motor_m(off_m_[cable]);
    for (std::size_t j = 0; j < far_end_m_.size(); ++j) {
        const double off_m = cables_.size() == 1 ? off_m_[0][j] : off_m_[0][j] - off_m_[1][j];
        far_end_by_m_[j] = far_end_.moves() ? -off_m / shared_by : 0.0;
        far_end_m_[j] += far_end_by_m_[j];
    }
    for (std::size_t cable = 0; cable < cables_.size(); ++cable) {
        for (double& each : off_m_[cable]) each = -each;
        cables_[cable].stretch(far_end_by_m_, off_m_[cable]);
        for (double& each : far_end_by_m_) each = -each;  // of cable B
    }
    oppose_far_end();
}

void EnsembleFilter::find_tension_N(std::size_t cable, const SensorSpot& spot,
                                    std::vector<double>& to) const {
    const EnsembleCable& own = cables_[cable];
    own.find_tension_N(spot, to);
    if (!pushes_[cable]) return;
    for (std::size_t j = 0; j < to.size(); ++j) {
        const int member = static_cast<int>(j);
        if (own.is_slack(member)) to[j] = own.pushing_tension_N(member, far_end_m(cable));
    }
}

void EnsembleFilter::sense(const Fitted& sensor) {
    switch (sensor.offer.kind) {
        case SensorKind::tension:
            find_tension_N(static_cast<std::size_t>(sensor.offer.cable), sensor.spot, sensed_);
            break;
        case SensorKind::motor_torque:
        case SensorKind::load_torque:  // E16 over the pulley's radius, or the tension of a single cable's end
            find_tension_N(0, sensor.spot, sensed_);
            if (cables_.size() == 1) break;
            find_tension_N(1, sensor.spot, workspace_);
            for (std::size_t j = 0; j < sensed_.size(); ++j) sensed_[j] -= workspace_[j];
            break;
        case SensorKind::load_displacement:
            cables_.front().find_distal_m(far_end_m_, sensed_);
            break;
    }
    for (std::size_t j = 0; j < sensed_.size(); ++j)
        sensed_[j] = sensed_[j] * (1.0 + sensor.gain[j]) + sensor.zero[j];
}

EnsembleFilter::Innovation EnsembleFilter::innovation(const Fitted& sensor, double reading) {
    sense(sensor);
    const RowMoments before = moments_of_row(sensed_);
    const double variance = before.deviation * before.deviation;
    const SensorErrors& errors = sensor.offer.errors;
    // Expected over the members: a small mean does not promise a small noise.
    const double proportional = errors.multiplicative_ratio * std::sqrt(before.mean * before.mean + variance);
    // A sensor without noise still has rounding: a millionth of what the members spread.
    const double noise_variance =
        std::max(proportional * proportional + errors.additive * errors.additive, 1e-12 * variance);
    return {before.mean, reading - before.mean, variance, noise_variance};
}

// The cables whose slack members cannot follow a reading that is off by so much.
bool EnsembleFilter::find_pushes(const Fitted& sensor, const Innovation& found) {
    const double surprising = surprising_deviations * std::sqrt(found.variance + found.noise_variance);
    const bool is_above = found.off > surprising;
    const bool is_below = found.off < -surprising;
    if (sensor.offer.kind == SensorKind::tension) {
        pushes_[static_cast<std::size_t>(sensor.offer.cable)] = is_above;
    } else if (sensor.offer.kind != SensorKind::load_displacement) {
        pushes_ = {is_above, is_below};
    }
    return pushes_[0] || pushes_[1];
}

// E58 for one reading, over the state and all numbers.
void EnsembleFilter::correct(Fitted& sensor, double reading) {
    const std::size_t count = sensed_.size();
    Innovation found = innovation(sensor, reading);
    if (find_pushes(sensor, found)) {
        oppose_far_end();
        found = innovation(sensor, reading);
    }
    pushes_ = {false, false};
    if (!(found.variance > 0.0)) return;
    const double total = found.variance + found.noise_variance;
    for (double& each : sensed_) each -= found.mean;
    const double degrees = static_cast<double>(count) - 1.0;
    RowCorrection correction{sensed_,         taut_move_,
                             found.off,       found.variance * degrees,
                             total * degrees, draws_.expected(tells_sum_)};
    for (EnsembleCable& cable : cables_) {
        for (std::size_t j = 0; j < count; ++j) taut_move_[j] = 1.0 - cable.slack()[j];
        corrected_.clear();
        cable.add_tensions(corrected_);
        correct_rows(correction, corrected_);
    }
    correction.moves = all_move_;
    corrected_ = {far_end_m_.data(), far_end_m_per_s_.data()};
    for (EnsembleCable& cable : cables_) cable.add_numbers(corrected_);
    for (Fitted& each : sensors_) {
        if (each.offer.errors.zero > 0.0) corrected_.push_back(each.zero.data());
        if (each.offer.errors.gain_ratio > 0.0) corrected_.push_back(each.gain.data());
    }
    correct_rows(correction, corrected_);
    for (EnsembleCable& cable : cables_) cable.take_pretension();
}

void EnsembleFilter::take_moments() {
    std::size_t at = 0;
    for (const EnsembleCable& cable : cables_) {
        for (int node = 0; node < cable.nodes(); ++node, ++at) {
            const RowMoments moments = cable.tension_moments_N(node);
            mean_N_[at] = moments.mean;
            deviation_N_[at] = moments.deviation;
        }
    }
}

}  // namespace capstan
