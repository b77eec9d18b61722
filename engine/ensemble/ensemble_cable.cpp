#include "capstan/ensemble/ensemble_cable.h"

#include <algorithm>

namespace capstan {

namespace {

// Static friction beyond the friction that depends on speed is left out, as on the bench (E18).
Cable nominal_cable(CableSpecification nominal, const RateFriction& friction) {
    if (friction.is_active()) nominal.static_friction = nominal.dynamic_friction;
    return Cable(nominal);
}

}  // namespace

EnsembleCable::EnsembleCable(const UncertainCable& cable, const CableBelief& belief,
                             const EnsembleDraws& draws, int which)
    : cable_(cable),
      members_(nominal_cable(cable.nominal(), belief.rate_friction), draws.members()),
      support_(belief.support),
      nominal_compliance_m_per_N_(Cable(cable.nominal()).mean_segment_compliance_m_per_N()),
      nominal_pretension_N_(cable.nominal().pretension_N) {
    const CableUncertainty& unknown = belief.uncertainty;
    const CableFactors& believed = belief.expected[static_cast<std::size_t>(which)];
    const int first_draw = which * drawn_numbers(cable);
    log_friction_ = spread(believed.log_friction, unknown.friction, draws.parameter(first_draw));
    log_stiffness_ = spread(believed.log_stiffness, unknown.stiffness, draws.parameter(first_draw + 1));
    log_pretension_ = spread(believed.log_pretension, unknown.pretension, draws.parameter(first_draw + 2));
    for (int bend = 0; bend < cable_.bends(); ++bend) {
        const auto b = static_cast<std::size_t>(bend);
        const double expected = b < believed.log_wrap.size() ? believed.log_wrap[b] : 0.0;
        log_wrap_.push_back(spread(expected, unknown.wrap, draws.parameter(first_draw + 3 + bend)));
    }
    const auto count = static_cast<std::size_t>(members_.members());
    for (auto* row : {&friction_, &pretension_N_, &distal_value_, &workspace_}) row->assign(count, 0.0);
    if (belief.rate_friction.is_active()) {
        rate_step_.emplace(belief.rate_friction, members_, Cable(cable.nominal()).mean_segment_length_m(),
                           belief.interval_s);
        wrap_rad_.assign(count * static_cast<std::size_t>(members_.segments()), 0.0);
    }
    take_numbers();
    for (int node = 0; node < members_.nodes(); ++node)
        std::copy(pretension_N_.begin(), pretension_N_.end(), members_.tension_N(node).begin());
    take_displacements(distal_value_);
}

EnsembleReport EnsembleCable::advance(double proximal_increment_m, std::span<const double> far_end_m) {
    moved_m_ += proximal_increment_m;
    const double stiffness = support_.spring_stiffness_N_per_m;
    for (std::size_t j = 0; j < distal_value_.size(); ++j)
        distal_value_[j] = stiffness > 0.0 ? pretension_N_[j] + stiffness * far_end_m[j] : far_end_m[j];
    const CableEnsemble::DistalEnd distal = stiffness > 0.0
                                                ? CableEnsemble::DistalEnd{stiffness, 1.0, distal_value_}
                                                : CableEnsemble::DistalEnd{1.0, 0.0, distal_value_};
    return rate_step_ ? rate_step_->advance(members_, wrap_rad_, proximal_increment_m, distal)
                      : members_.advance(proximal_increment_m, distal);
}

void EnsembleCable::add_tensions(std::vector<double*>& rows) {
    for (int node = 0; node < members_.nodes(); ++node) rows.push_back(members_.tension_N(node).data());
}

void EnsembleCable::add_numbers(std::vector<double*>& rows) {
    for (auto* row : {&log_friction_, &log_stiffness_, &log_pretension_}) rows.push_back(row->data());
    for (auto& row : log_wrap_) rows.push_back(row.data());
}

void EnsembleCable::settle(std::span<const double> far_end_m) {
    std::vector<double>& highest_N = workspace_;
    clip_tensions(rows(), highest_N.data());
    for (std::size_t j = 0; j < highest_N.size(); ++j)
        if (!(highest_N[j] > 0.0) && !is_slack(static_cast<int>(j))) members_.make_slack(static_cast<int>(j));
    take_numbers();
    take_displacements(far_end_m);
    const auto proximal_m = members_.displacement_m(0);
    for (std::size_t j = 0; j < proximal_m.size(); ++j)
        if (is_slack(static_cast<int>(j))) proximal_m[j] = rest_m(j) + moved_m_;
}

// E2 from the distal end to the proximal one, less where the motor has put it.
void EnsembleCable::find_off_motor_m(std::span<double> off_m) const {
    const auto proximal_m = members_.displacement_m(0);
    for (std::size_t j = 0; j < off_m.size(); ++j)
        off_m[j] = is_slack(static_cast<int>(j)) ? 0.0 : proximal_m[j] - rest_m(j) - moved_m_;
}

// The proximal end under pretension, the distal end at 0.
double EnsembleCable::rest_m(std::size_t member) const {
    return -members_.segments() * members_.compliance_m_per_N()[member] * pretension_N_[member];
}

void EnsembleCable::stretch(std::span<const double> far_end_by_m, std::span<const double> proximal_by_m) {
    const double stiffness = support_.spring_stiffness_N_per_m;
    stretch_rows(rows(), far_end_by_m.data(), proximal_by_m.data(), stiffness > 0.0 ? 1.0 / stiffness : 0.0);
}

void EnsembleCable::find_tension_N(const SensorSpot& spot, std::span<double> tension_N) const {
    const auto here_N = members_.tension_N(spot.node);
    const auto next_N = members_.tension_N(spot.node + 1);
    for (std::size_t j = 0; j < tension_N.size(); ++j)
        tension_N[j] = (1.0 - spot.fraction) * here_N[j] + spot.fraction * next_N[j];
}

double EnsembleCable::pushing_tension_N(int member, std::span<const double> far_end_m) const {
    const auto j = static_cast<std::size_t>(member);
    const double stiffness = support_.spring_stiffness_N_per_m;
    const double spring_m_per_N = stiffness > 0.0 ? 1.0 / stiffness : 0.0;
    const double all_m_per_N = members_.segments() * members_.compliance_m_per_N()[j] + spring_m_per_N;
    return pretension_N_[j] + (far_end_m[j] - moved_m_) / all_m_per_N;
}

void EnsembleCable::find_distal_m(std::span<const double> far_end_m, std::span<double> distal_m) const {
    std::copy(far_end_m.begin(), far_end_m.end(), distal_m.begin());
    const double stiffness = support_.spring_stiffness_N_per_m;
    if (!(stiffness > 0.0)) return;
    const auto distal_N = members_.tension_N(members_.segments());
    for (std::size_t j = 0; j < distal_m.size(); ++j)
        distal_m[j] += (pretension_N_[j] - distal_N[j]) / stiffness;
}

void EnsembleCable::take_pretension() {
    exp_row(log_pretension_, pretension_N_);
    for (double& each : pretension_N_) each *= nominal_pretension_N_;
}

void EnsembleCable::take_numbers() {
    const auto compliance = members_.compliance_m_per_N();
    exp_row(log_stiffness_, workspace_);
    for (std::size_t j = 0; j < compliance.size(); ++j)
        compliance[j] = nominal_compliance_m_per_N_ / workspace_[j];
    take_pretension();
    exp_row(log_friction_, friction_);
    for (int segment = 0; segment < members_.segments(); ++segment) {
        const auto exponent = members_.sliding_exponent(segment);
        std::fill(exponent.begin(), exponent.end(), 0.0);
    }
    std::fill(wrap_rad_.begin(), wrap_rad_.end(), 0.0);
    const double friction = cable_.nominal().dynamic_friction;
    for (int bend = 0; bend < cable_.bends(); ++bend) {
        exp_row(log_wrap_[static_cast<std::size_t>(bend)], workspace_);
        add_wrap(bend, workspace_);
        for (std::size_t j = 0; j < workspace_.size(); ++j) workspace_[j] *= friction * friction_[j];
        for (int segment = 0; segment < members_.segments(); ++segment) {
            const double wrap_rad = cable_.wrap_of_bend_rad(bend)[static_cast<std::size_t>(segment)];
            if (wrap_rad == 0.0) continue;
            const auto exponent = members_.sliding_exponent(segment);
            for (std::size_t j = 0; j < exponent.size(); ++j) exponent[j] += wrap_rad * workspace_[j];
        }
    }
    members_.retune();
}

// Of friction that depends on speed, which needs the wrap itself.
void EnsembleCable::add_wrap(int bend, std::span<const double> factor) {
    const std::vector<double>& nominal_rad = cable_.wrap_of_bend_rad(bend);
    for (std::size_t k = 0; k < wrap_rad_.size(); ++k)
        wrap_rad_[k] += nominal_rad[k / factor.size()] * factor[k % factor.size()];
}

void EnsembleCable::take_displacements(std::span<const double> far_end_m) {
    find_distal_m(far_end_m, workspace_);
    place_nodes(rows(), workspace_.data());
}

CableRows EnsembleCable::rows() {
    return {static_cast<std::size_t>(members_.members()),
            members_.nodes(),
            members_.tension_N(0).data(),
            members_.displacement_m(0).data(),
            members_.compliance_m_per_N().data(),
            members_.relative_length().data(),
            members_.slack().data()};
}

}  // namespace capstan
