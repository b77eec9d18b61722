// A cable in each lane. A member never depends on its neighbours, so the number of lanes of the processor
// changes nothing but the last digit of the exponentials.
#include "capstan/solver/cable_ensemble.h"

#include <cmath>
#include <string>

#include "capstan/cable/invalid_input.h"
#include "capstan/solver/chosen_target.h"
#include "capstan/solver/pattern_search.h"
#include "capstan/solver/sliding_front.h"
#include "capstan/solver/sliding_run.h"
#include "capstan/solver/solvable_ends.h"

// foreach_target.h comes before highway.h.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/solver/cable_ensemble.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

#ifndef CAPSTAN_ENSEMBLE_VIEW
#define CAPSTAN_ENSEMBLE_VIEW
namespace capstan {

// What the kernel sees of an ensemble: rows of members.
struct EnsembleView {
    std::size_t members;
    int nodes;
    double static_to_dynamic;
    double* tension_N;
    double* displacement_m;
    const double* exponent;
    double* sliding_ratio;
    double* breakaway_ratio;
    const double* compliance_m_per_N;
    const double* relative_length;
    double* next_tension_N;
    double* next_displacement_m;
    double* proximal_direction;
    double* proximal_count;
    double* distal_direction;
    double* distal_count;
};

struct EnsembleInputs {
    double proximal_increment_m;
    double displacement_factor;
    double tension_factor;
    const double* value;  // members
    double* left;         // members: in: 1 for those to leave out; out: 1 for those not solved
};

}  // namespace capstan
#endif

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using EnsembleTag = hn::CappedTag<double, 8>;
using Lanes = hn::Vec<EnsembleTag>;
using Which = hn::Mask<EnsembleTag>;

HWY_INLINE Lanes lanes_of(double value) {
    return hn::Set(EnsembleTag(), value);
}

void make_ratios(const EnsembleView& view) {
    const EnsembleTag d;
    const std::size_t count = view.members * static_cast<std::size_t>(view.nodes - 1);
    const Lanes one = lanes_of(1.0);
    for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
        const Lanes exponent = hn::Load(d, view.exponent + k);
        const bool is_straight = hn::AllTrue(d, hn::Eq(exponent, hn::Zero(d)));
        hn::Store(is_straight ? one : hn::Exp(d, exponent), d, view.sliding_ratio + k);
        hn::Store(is_straight ? one : hn::Exp(d, hn::Mul(exponent, lanes_of(view.static_to_dynamic))), d,
                  view.breakaway_ratio + k);
    }
}

// One side's motion in every lane. `outward` is +1 at the proximal end, -1 at the distal one, as CableEnd's
// orientation.
struct LaneSide {
    Lanes direction;  // -1, 0, 1
    Lanes count;      // moving nodes
    Lanes tension_N;  // of the end node, where count is less than all nodes
    Lanes displacement_m;
};

// The kernel for the members `at` to `at + lanes`.
struct LaneStep {
    const EnsembleView& view;
    const EnsembleInputs& inputs;
    std::size_t at;
    int last = view.nodes - 1;
    Lanes mean_half = hn::Mul(lanes_of(0.5), hn::Load(EnsembleTag(), view.compliance_m_per_N + at));

    HWY_INLINE Lanes row(const double* rows, int index) const {
        return hn::Load(EnsembleTag(), rows + static_cast<std::size_t>(index) * view.members + at);
    }
    HWY_INLINE Lanes half_of(int segment) const {
        return hn::Mul(mean_half, lanes_of(view.relative_length[segment]));
    }
    HWY_INLINE Lanes tension_N(int node) const { return row(view.tension_N, node); }
    HWY_INLINE Lanes displacement_m(int node) const { return row(view.displacement_m, node); }

    // E4: mu_d holds a segment that slid in the step before, mu_s one that rested.
    HWY_INLINE Lanes holding_ratio(int segment) const {
        const Lanes near = hn::Load(EnsembleTag(), view.proximal_count + at);
        const Lanes far = hn::Load(EnsembleTag(), view.distal_count + at);
        const Which slid = hn::Or(hn::Lt(lanes_of(segment + 1), near),
                                  hn::Gt(lanes_of(segment), hn::Sub(lanes_of(last), far)));
        return hn::IfThenElse(slid, row(view.sliding_ratio, segment), row(view.breakaway_ratio, segment));
    }

    // Tension across a segment, seen outward, for a side that slides in `direction`.
    template <int outward>
    HWY_INLINE Lanes beyond(Lanes tension, int segment, Which grows) const {
        const Lanes ratio = row(view.sliding_ratio, segment);
        return hn::IfThenElse(grows, hn::Mul(tension, ratio), hn::Div(tension, ratio));
    }
    template <int outward>
    static HWY_INLINE Which grows_outward(Lanes direction) {
        const Lanes zero = lanes_of(0.0);
        return outward > 0 ? hn::Gt(direction, zero) : hn::Lt(direction, zero);
    }

    // driven_direction() of sliding_front.h.
    template <int outward>
    HWY_INLINE Lanes driven(Lanes value, double displacement_factor, double tension_factor) const {
        const int end = outward > 0 ? 0 : last;
        const Lanes by_displacement = hn::Mul(lanes_of(displacement_factor), displacement_m(end));
        const Lanes by_tension = hn::Mul(lanes_of(tension_factor), tension_N(end));
        const Lanes change = hn::Sub(value, hn::Add(by_displacement, by_tension));
        const Lanes scale = hn::Add(hn::Abs(displacement_m(0)), hn::Abs(displacement_m(last)));
        const Lanes rounding =
            hn::Mul(lanes_of(input_rounding), hn::Add(hn::Mul(lanes_of(std::abs(displacement_factor)), scale),
                                                      hn::Add(hn::Abs(by_tension), hn::Abs(value))));
        const Lanes way = hn::CopySign(lanes_of(1.0), change);
        return hn::IfThenElseZero(hn::Gt(hn::Abs(change), rounding), way);
    }

    // E3 and E4: how far the side's front goes.
    template <int outward>
    HWY_INLINE LaneSide front(Lanes direction, Lanes value, double displacement_factor, double tension_factor,
                              Lanes first_count) const {
        const EnsembleTag d;
        const Lanes zero = lanes_of(0.0);
        const Which grows = grows_outward<outward>(direction);
        LaneSide side{direction, zero, zero, zero};
        Which open = hn::Ne(direction, zero);
        side.count = hn::IfThenElseZero(open, lanes_of(view.nodes));
        Lanes ratio = lanes_of(1.0);
        Lanes elongation = zero;
        for (int count = 1; count <= last && !hn::AllFalse(d, open); ++count) {
            const int resting = outward > 0 ? count : last - count;
            const int segment = outward > 0 ? count - 1 : last - count;
            const Lanes half = half_of(segment);
            const Lanes compliance = hn::Add(elongation, hn::Mul(half, ratio));
            const Lanes rest_N = tension_N(resting);
            const Lanes anchor =
                hn::Sub(displacement_m(resting), hn::Mul(lanes_of(outward), hn::Mul(half, rest_N)));
            const Lanes over = hn::Sub(lanes_of(tension_factor),
                                       hn::Mul(lanes_of(outward * displacement_factor), compliance));
            const Lanes tension =
                hn::Div(hn::Sub(value, hn::Mul(lanes_of(displacement_factor), anchor)), over);
            const Lanes front_N = hn::Mul(tension, ratio);
            const Lanes hold = holding_ratio(segment);
            const Which gives_growing = hn::And(grows, hn::Ge(rest_N, hn::Mul(front_N, hold)));
            const Which gives_falling = hn::AndNot(grows, hn::Ge(front_N, hn::Mul(rest_N, hold)));
            const Which holds =
                hn::AndNot(hn::Or(gives_growing, gives_falling), hn::Ge(lanes_of(count), first_count));
            const Which stops = hn::And(open, holds);
            side.count = hn::IfThenElse(stops, lanes_of(count), side.count);
            side.tension_N = hn::IfThenElse(stops, tension, side.tension_N);
            side.displacement_m = hn::IfThenElse(
                stops, hn::Sub(anchor, hn::Mul(lanes_of(outward), hn::Mul(compliance, tension))),
                side.displacement_m);
            open = hn::AndNot(stops, open);
            const Lanes next = beyond<outward>(ratio, segment, grows);
            elongation = hn::Add(elongation, hn::Mul(half, hn::Add(ratio, next)));
            ratio = next;
        }
        return side;
    }

    // Writes the nodes of a side into the next state; the lanes where every one moved its pattern's way (E5)
    // and the last one is held from both sides by its resting neighbour (E4).
    template <int outward>
    HWY_INLINE Which write(const LaneSide& side, Which wanted) const {
        const EnsembleTag d;
        const Lanes zero = lanes_of(0.0);
        const Which grows = grows_outward<outward>(side.direction);
        Lanes tension = side.tension_N;
        Lanes displacement = side.displacement_m;
        Which good = hn::Eq(zero, zero);
        for (int k = 0; k <= last; ++k) {
            const int node = outward > 0 ? k : last - k;
            const Which moving = hn::And(wanted, hn::Lt(lanes_of(k), side.count));
            if (hn::AllFalse(d, moving)) break;
            const Lanes slid = hn::Mul(side.direction, hn::Sub(displacement, displacement_m(node)));
            good = hn::AndNot(hn::And(moving, hn::Lt(slid, lanes_of(-displacement_rounding_m))), good);
            double* next_N = view.next_tension_N + static_cast<std::size_t>(node) * view.members + at;
            double* next_m = view.next_displacement_m + static_cast<std::size_t>(node) * view.members + at;
            hn::Store(hn::IfThenElse(moving, tension, hn::Load(d, next_N)), d, next_N);
            hn::Store(hn::IfThenElse(moving, displacement, hn::Load(d, next_m)), d, next_m);
            if (k == last) break;
            const int segment = outward > 0 ? k : last - 1 - k;
            const int neighbour = outward > 0 ? k + 1 : last - 1 - k;
            const Which front = hn::And(moving, hn::Eq(lanes_of(k + 1), side.count));
            const Lanes hold = hn::Mul(holding_ratio(segment), lanes_of(1.0 + tension_rounding));
            const Lanes rest_N = tension_N(neighbour);
            const Which held =
                hn::And(hn::Le(tension, hn::Mul(rest_N, hold)), hn::Le(rest_N, hn::Mul(tension, hold)));
            good = hn::AndNot(hn::AndNot(held, front), good);
            const Lanes next = beyond<outward>(tension, segment, grows);
            displacement = hn::Add(
                displacement, hn::Mul(lanes_of(outward), hn::Mul(half_of(segment), hn::Add(tension, next))));
            tension = next;
        }
        return good;
    }

    HWY_INLINE void run() const {
        const EnsembleTag d;
        const Lanes zero = lanes_of(0.0);
        const Lanes all_nodes = lanes_of(view.nodes);
        const Lanes proximal_m = hn::Add(displacement_m(0), lanes_of(inputs.proximal_increment_m));
        const Lanes value = hn::LoadU(d, inputs.value + at);
        const double u = inputs.displacement_factor;
        const double t = inputs.tension_factor;
        double* const motion[] = {view.proximal_direction + at, view.proximal_count + at,
                                  view.distal_direction + at, view.distal_count + at};

        const Lanes near_way = driven<1>(proximal_m, 1.0, 0.0);
        const Lanes far_way = driven<-1>(value, u, t);
        const auto remembered = [&](Lanes way, const double* direction, const double* count) HWY_ATTR {
            return hn::IfThenElseZero(hn::Eq(way, hn::Load(d, direction)), hn::Load(d, count));
        };
        LaneSide near = front<1>(near_way, proximal_m, 1.0, 0.0, remembered(near_way, motion[0], motion[1]));
        LaneSide far = front<-1>(far_way, value, u, t, remembered(far_way, motion[2], motion[3]));

        // E1, E2 and E6 where the sides meet and are driven one way.
        const Which meet = hn::Ge(hn::Add(near.count, far.count), all_nodes);
        const Which against = hn::Lt(hn::Mul(near_way, far_way), zero);
        const Lanes way = hn::IfThenElse(hn::Ne(near_way, zero), near_way, far_way);
        // Fronts that meet in one segment may leave its middle at rest (E8): rare, and left to the search.
        const Which one_way = hn::Gt(hn::Mul(near_way, far_way), zero);
        const Which in_one_segment = hn::And(one_way, hn::Eq(hn::Add(near.count, far.count), all_nodes));
        Which good = hn::AndNot(in_one_segment, hn::Not(hn::And(meet, against)));
        if (!hn::AllFalse(d, meet)) {
            const Which grows = grows_outward<1>(way);
            Lanes ratio = lanes_of(1.0);
            Lanes elongation = zero;
            for (int segment = 0; segment < last; ++segment) {
                const Lanes next = beyond<1>(ratio, segment, grows);
                elongation = hn::Add(elongation, hn::Mul(half_of(segment), hn::Add(ratio, next)));
                ratio = next;
            }
            const Lanes factor = hn::Add(hn::Mul(lanes_of(u), elongation), hn::Mul(lanes_of(t), ratio));
            const Lanes tension = hn::Div(hn::Sub(value, hn::Mul(lanes_of(u), proximal_m)), factor);
            good = hn::AndNot(hn::And(meet, hn::Not(hn::Gt(tension, zero))), good);
            near.direction = hn::IfThenElse(meet, way, near.direction);
            near.count = hn::IfThenElse(meet, all_nodes, near.count);
            near.tension_N = hn::IfThenElse(meet, tension, near.tension_N);
            near.displacement_m = hn::IfThenElse(meet, proximal_m, near.displacement_m);
            far.direction = hn::IfThenElse(meet, way, far.direction);
        }
        for (int node = 0; node <= last; ++node) {
            const std::size_t to = static_cast<std::size_t>(node) * view.members + at;
            hn::Store(tension_N(node), d, view.next_tension_N + to);
            hn::Store(displacement_m(node), d, view.next_displacement_m + to);
        }
        const Which everywhere = hn::Eq(zero, zero);
        good = hn::And(good, write<1>(near, everywhere));
        good = hn::And(good, write<-1>(far, hn::Not(meet)));
        far.count = hn::IfThenElse(meet, all_nodes, far.count);
        pin(near, far, proximal_m, value);

        const Lanes size = hn::Add(hn::Abs(near.tension_N), hn::Abs(far.tension_N));
        good = hn::And(good, hn::Le(size, lanes_of(largest_number)));
        // A slack member has no front; the search knows about it.
        good = hn::And(good, hn::Eq(hn::Load(d, inputs.left + at), zero));

        for (int node = 0; node <= last; ++node) {
            const std::size_t to = static_cast<std::size_t>(node) * view.members + at;
            hn::Store(hn::IfThenElse(good, hn::Load(d, view.next_tension_N + to), tension_N(node)), d,
                      view.tension_N + to);
            hn::Store(hn::IfThenElse(good, hn::Load(d, view.next_displacement_m + to), displacement_m(node)),
                      d, view.displacement_m + to);
        }
        const Lanes moved[] = {near.direction, near.count, far.direction, far.count};
        for (int k = 0; k < 4; ++k)
            hn::Store(hn::IfThenElse(good, moved[k], hn::Load(d, motion[k])), d, motion[k]);
        hn::Store(hn::IfThenElse(good, zero, lanes_of(1.0)), d, inputs.left + at);
    }

    // A prescribed displacement is written as prescribed: the rounding of a sum must not drive the next step.
    HWY_INLINE void pin(const LaneSide& near, const LaneSide& far, Lanes proximal_m, Lanes value) const {
        const EnsembleTag d;
        double* first_m = view.next_displacement_m + at;
        hn::Store(hn::IfThenElse(hn::Gt(near.count, lanes_of(0.0)), proximal_m, hn::Load(d, first_m)), d,
                  first_m);
        if (inputs.tension_factor != 0.0) return;
        double* last_m = view.next_displacement_m + static_cast<std::size_t>(last) * view.members + at;
        const Lanes pinned = hn::Div(value, lanes_of(inputs.displacement_factor));
        hn::Store(hn::IfThenElse(hn::Gt(far.count, lanes_of(0.0)), pinned, hn::Load(d, last_m)), d, last_m);
    }
};

void step_members(const EnsembleView& view, const EnsembleInputs& inputs) {
    for (std::size_t at = 0; at < view.members; at += hn::Lanes(EnsembleTag()))
        LaneStep{view, inputs, at}.run();
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace capstan {

HWY_EXPORT(make_ratios);
HWY_EXPORT(step_members);

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
    for (NodeTable* rows : {&sliding_exponent_, &sliding_ratio_, &breakaway_ratio_})
        rows->assign(by_segments, 0.0);
    compliance_m_per_N_.assign(members_, cable.mean_segment_compliance_m_per_N());
    relative_length_.assign(cable.relative_length().begin(), cable.relative_length().end());
    motion_.assign(4 * static_cast<std::size_t>(members_), 0.0);
    slack_.assign(members_, 0);
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
    HWY_DYNAMIC_DISPATCH(make_ratios)(EnsembleLanes::view_of(*this));
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
    slack_[member] = 1;
    for (int k = 0; k < 4; ++k) row(motion_, k)[member] = 0.0;
}

EnsembleReport CableEnsemble::advance(double proximal_increment_m, const DistalEnd& distal) {
    bool finite = std::isfinite(proximal_increment_m);
    for (const double value : distal.value) finite = finite && std::isfinite(value);
    if (!finite) throw InvalidInput({"cable ensemble: an input of this step is not a finite number"});
    for (int member = 0; member < members_; ++member) left_[member] = slack_[member];
    static const auto step = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(step_members); });
    step(EnsembleLanes::view_of(*this), {proximal_increment_m, distal.displacement_factor,
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
    slack_[member] = pattern.kind == MotionKind::slack ? 1 : 0;
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
    pattern.kind = slack_[member] != 0 ? MotionKind::slack
                   : moving == 0       ? MotionKind::rest
                   : moving < nodes_   ? MotionKind::partial
                   : moving == nodes_  ? MotionKind::opposed
                                       : MotionKind::mass;
    return pattern;
}

}  // namespace capstan
#endif
