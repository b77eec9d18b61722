#include "capstan/solver/cable_ensemble.h"

#include <cmath>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/ensemble_view.h"
#include "capstan/solver/pattern_search.h"

namespace capstan {

struct EnsembleLanes {
    static EnsembleView view_of(CableEnsemble& e) {
        const auto members = static_cast<std::size_t>(e.members_);
        double* motion = e.motion_.data();
        return {members,
                e.nodes_,
                e.static_to_dynamic_,
                e.tension_N_.data(),
                e.displacement_m_.data(),
                e.sliding_exponent_.data(),
                e.sliding_ratio_.data(),
                e.inverse_ratio_.data(),
                e.breakaway_ratio_.data(),
                e.compliance_m_per_N_.data(),
                e.relative_length_.data(),
                e.next_tension_N_.data(),
                e.next_displacement_m_.data(),
                motion,
                motion + members,
                motion + 2 * members,
                motion + 3 * members};
    }
};

namespace {

constexpr int lanes_at_most = 8;

const Cable& checked(const Cable& cable, int members) {
    if (members < lanes_at_most || members % lanes_at_most != 0)
        throw InvalidInput(
            {"cable ensemble: " + std::to_string(members) + " members; take a multiple of 8, at least 8"});
    return cable;
}

}  // namespace

CableEnsemble::CableEnsemble(const Cable& cable, int members)
    : members_(members),
      nodes_(checked(cable, members).nodes()),
      static_to_dynamic_(cable.dynamic_friction() > 0.0 ? cable.static_friction() / cable.dynamic_friction()
                                                        : 1.0),
      scratch_(pretensioned(cable)),
      scratch_tables_(cable, ModelRules::consistent()) {
    const auto by_nodes = static_cast<std::size_t>(nodes_) * members_;
    const auto by_segments = by_nodes - members_;
    for (NodeTable* rows : {&tension_N_, &displacement_m_, &next_tension_N_, &next_displacement_m_})
        rows->assign(by_nodes, 0.0);
    for (NodeTable* rows : {&sliding_exponent_, &sliding_ratio_, &inverse_ratio_, &breakaway_ratio_})
        rows->assign(by_segments, 0.0);
    compliance_m_per_N_.assign(members_, cable.mean_segment_compliance_m_per_N());
    relative_length_.assign(cable.relative_length().begin(), cable.relative_length().end());
    motion_.assign(4 * static_cast<std::size_t>(members_), 0.0);
    slack_.assign(members_, 0.0);
    left_.assign(members_, 0.0);
    for (int node = 0; node < nodes_; ++node) {
        for (double& each : tension_N(node)) each = scratch_.tension_N[node];
        for (double& each : displacement_m(node)) each = scratch_.displacement_m[node];
    }
    for (int s = 0; s < segments(); ++s)
        for (double& each : sliding_exponent(s)) each = cable.dynamic_friction() * cable.wrap_angle_rad()[s];
    retune();
}

void CableEnsemble::retune() {
    make_ensemble_ratios(EnsembleLanes::view_of(*this));
}

CableState CableEnsemble::state_of(int member) const {
    CableState state;
    for (int node = 0; node < nodes_; ++node) {
        state.tension_N.push_back(tension_N(node)[member]);
        state.displacement_m.push_back(displacement_m(node)[member]);
    }
    state.last_motion = pattern_of(member);
    return state;
}

void CableEnsemble::make_slack(int member) {
    slack_[member] = 1.0;
    for (int k = 0; k < 4; ++k) row(motion_, k)[member] = 0.0;
}

EnsembleReport CableEnsemble::advance(double proximal_increment_m, const DistalEnd& distal) {
    bool finite = std::isfinite(proximal_increment_m);
    for (const double value : distal.value) finite = finite && std::isfinite(value);
    if (!finite) throw InvalidInput({"cable ensemble: an input of this step is not a finite number"});
    left_ = slack_;
    step_ensemble(EnsembleLanes::view_of(*this), {proximal_increment_m, distal.displacement_factor,
                                                  distal.tension_factor, distal.value.data(), left_.data()});
    EnsembleReport report;
    for (int member = 0; member < members_; ++member) {
        if (left_[member] == 0.0) continue;
        ++report.searched;
        const EndConditions ends{EndCondition::position_m(displacement_m(0)[member] + proximal_increment_m),
                                 {distal.displacement_factor, distal.tension_factor, distal.value[member]}};
        if (!search(member, ends)) ++report.unverified;
    }
    return report;
}

// What QuasiStaticStep does where its first candidate fails, for one member.
bool CableEnsemble::search(int member, const EndConditions& ends) {
    for (int node = 0; node < nodes_; ++node) {
        scratch_.tension_N[node] = tension_N(node)[member];
        scratch_.displacement_m[node] = displacement_m(node)[member];
    }
    scratch_.last_motion = pattern_of(member);
    scratch_tables_.assign(compliance_m_per_N_[member], &sliding_exponent_[member], &sliding_ratio_[member],
                           &breakaway_ratio_[member], static_cast<std::size_t>(members_));
    static constexpr ModelRules rules = ModelRules::consistent();
    const StepView view{scratch_tables_, rules, scratch_};
    const PatternSearch found = search_pattern(view, ends);
    if (!is_finite(found.candidate))
        throw InvalidInput(
            {"cable ensemble: the ends' inputs ask a member for a tension or displacement that is "
             "not a finite number below 1e150"});
    write_state(view, found.candidate, ends, scratch_);
    for (int node = 0; node < nodes_; ++node) {
        tension_N(node)[member] = scratch_.tension_N[node];
        displacement_m(node)[member] = scratch_.displacement_m[node];
    }
    const MotionPattern& pattern = scratch_.last_motion;
    slack_[member] = pattern.kind == MotionKind::slack ? 1.0 : 0.0;
    row(motion_, 0)[member] = sign(pattern.proximal_direction);
    row(motion_, 1)[member] = pattern.proximal_moving_nodes;
    row(motion_, 2)[member] = sign(pattern.distal_direction);
    row(motion_, 3)[member] = pattern.distal_moving_nodes;
    return found.verified;
}

// Counts and directions are what a step remembers; of the kinds it only tells slack from the others.
MotionPattern CableEnsemble::pattern_of(int member) const {
    MotionPattern pattern;
    pattern.proximal_direction = direction_of(row(motion_, 0)[member]);
    pattern.proximal_moving_nodes = static_cast<int>(row(motion_, 1)[member]);
    pattern.distal_direction = direction_of(row(motion_, 2)[member]);
    pattern.distal_moving_nodes = static_cast<int>(row(motion_, 3)[member]);
    const int moving = pattern.proximal_moving_nodes + pattern.distal_moving_nodes;
    pattern.kind = is_slack(member)   ? MotionKind::slack
                   : moving == 0      ? MotionKind::rest
                   : moving < nodes_  ? MotionKind::partial
                   : moving == nodes_ ? MotionKind::opposed
                                      : MotionKind::mass;
    return pattern;
}

}  // namespace capstan
