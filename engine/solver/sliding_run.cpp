// The two loops over nodes are almost all the cost of a step on a long cable, so they run on whatever SIMD the
// processor has (Highway, chosen at run time). No fused multiply-add and no sum in them: the same bits on
// every processor.
#include "capstan/solver/sliding_run.h"

#include "capstan/solver/chosen_target.h"

// foreach_target.h comes before highway.h.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capstan/solver/sliding_run.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace capstan::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::ScalableTag<double>;

// Calls `at(node)` for complete vectors of the run, four in a row where it is long. The last one overlaps the
// one before instead of leaving single nodes over. False if the run is shorter than a vector.
template <class AtVector>
HWY_INLINE bool for_each_vector(const SlidingRun& run, AtVector&& at) {
    const int lanes = static_cast<int>(hn::Lanes(Tag()));
    const int last = run.end - lanes;
    if (last < run.first) return false;
    int node = run.first;
    for (; node <= last - 4 * lanes; node += 4 * lanes) {
        at(node);
        at(node + lanes);
        at(node + 2 * lanes);
        at(node + 3 * lanes);
    }
    for (; node < last; node += lanes) at(node);
    at(last);
    return true;
}

// True if `now` is at most displacement_rounding_m behind `before`, seen along the direction, at every node.
template <class Increment>
HWY_INLINE bool no_node_lags(const SlidingRun& run, const double* HWY_RESTRICT before_m,
                             Increment&& increment) {
    const Tag d;
    const double* HWY_RESTRICT elongation = run.elongation_m_per_N;
    const auto anchor = hn::Set(d, run.anchor_m);
    const auto slope = hn::Set(d, run.slope_N);
    const auto lowest = hn::Set(d, -displacement_rounding_m);
    auto least = lowest;
    const bool vectors = for_each_vector(run, [&](int node) HWY_ATTR {
        const auto now = hn::Add(anchor, hn::Mul(slope, hn::LoadU(d, elongation + node)));
        least = hn::Min(least, increment(now, hn::LoadU(d, before_m + node)));
    });
    if (vectors) return hn::AllTrue(d, hn::Ge(least, lowest));
    const double way = sign(run.direction);
    for (int node = run.first; node < run.end; ++node) {
        const double increment_m = run.anchor_m + run.slope_N * elongation[node] - before_m[node];
        if (way * increment_m < -displacement_rounding_m) return false;
    }
    return true;
}

HWY_INLINE bool run_moves(const SlidingRun& run, const double* HWY_RESTRICT before_m) {
    if (run.direction == Direction::forward) {
        return no_node_lags(run, before_m,
                            [](auto now, auto before) HWY_ATTR { return hn::Sub(now, before); });
    }
    return no_node_lags(run, before_m, [](auto now, auto before) HWY_ATTR { return hn::Sub(before, now); });
}

HWY_INLINE void write(const SlidingRun& run, double* HWY_RESTRICT tension_N,
                      double* HWY_RESTRICT displacement_m) {
    const Tag d;
    const double* HWY_RESTRICT ratio = run.ratio;
    const double* HWY_RESTRICT elongation = run.elongation_m_per_N;
    const auto scale = hn::Set(d, run.scale_N);
    const auto anchor = hn::Set(d, run.anchor_m);
    const auto slope = hn::Set(d, run.slope_N);
    const bool vectors = for_each_vector(run, [&](int node) HWY_ATTR {
        hn::StoreU(hn::Mul(scale, hn::LoadU(d, ratio + node)), d, tension_N + node);
        hn::StoreU(hn::Add(anchor, hn::Mul(slope, hn::LoadU(d, elongation + node))), d,
                   displacement_m + node);
    });
    if (vectors) return;
    for (int node = run.first; node < run.end; ++node) {
        tension_N[node] = run.scale_N * ratio[node];
        displacement_m[node] = run.anchor_m + run.slope_N * elongation[node];
    }
}

bool every_node_moves(const SlidingRun& run, const double* before_m) {
    return run_moves(run, before_m);
}

void write_nodes(const SlidingRun& run, double* tension_N, double* displacement_m) {
    write(run, tension_N, displacement_m);
}

bool write_if_all_move(const SlidingRun& proximal, const SlidingRun& distal, double* tension_N,
                       double* displacement_m) {
    if (distal.empty()) {
        if (!run_moves(proximal, displacement_m)) return false;
        write(proximal, tension_N, displacement_m);
        return true;
    }
    if (!every_node_moves(proximal, displacement_m) || !every_node_moves(distal, displacement_m))
        return false;
    write_nodes(proximal, tension_N, displacement_m);
    write_nodes(distal, tension_N, displacement_m);
    return true;
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace capstan {

HWY_EXPORT(every_node_moves);
HWY_EXPORT(write_nodes);
HWY_EXPORT(write_if_all_move);

namespace {

// The paper's check, for its own figures.
bool every_segment_moves_in_the_mean(const SlidingRun& run, const double* before_m) {
    const double way = sign(run.direction);
    const auto increment_m = [&](int node) {
        return run.anchor_m + run.slope_N * run.elongation_m_per_N[node] - before_m[node];
    };
    for (int node = run.first; node + 1 < run.end; ++node) {
        if (way * (increment_m(node) + increment_m(node + 1)) < -displacement_rounding_m) return false;
    }
    return true;
}

}  // namespace

bool moves(const SlidingRun& run, const StepView& view) {
    if (run.empty()) return true;
    const double* before_m = view.before.displacement_m.data();
    switch (view.rules.check) {
        case VelocityCheck::every_node:
            return HWY_DYNAMIC_DISPATCH(every_node_moves)(run, before_m);
        case VelocityCheck::segment_mean:
            return every_segment_moves_in_the_mean(run, before_m);
    }
    return false;
}

void write_run(const SlidingRun& run, CableState& state) {
    if (run.empty()) return;
    HWY_DYNAMIC_DISPATCH(write_nodes)(run, state.tension_N.data(), state.displacement_m.data());
}

bool write_if_every_node_moves(const SlidingRun& proximal, const SlidingRun& distal, double* tension_N,
                               double* displacement_m) {
    static const auto chosen = for_this_processor(+[] { return &HWY_DYNAMIC_DISPATCH(write_if_all_move); });
    return chosen(proximal, distal, tension_N, displacement_m);
}

}  // namespace capstan
#endif
