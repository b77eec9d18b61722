// The two loops over nodes are the whole cost of a step on a long cable, so they run on whatever SIMD the
// processor has (Highway, chosen at run time). No fused multiply-add and no sum in them: the same bits on
// every processor.
#include "capstan/solver/sliding_run.h"

#include <algorithm>

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

// True if every node of the run moves by `lowest` or more along `direction` (+1 or -1).
bool every_node_moves(const SlidingRun& run, double direction, const double* HWY_RESTRICT before_m,
                      double lowest) {
    const hn::ScalableTag<double> d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const double* HWY_RESTRICT elongation = run.elongation_m_per_N;
    const auto way = hn::Set(d, direction);
    const auto anchor = hn::Set(d, run.anchor_m);
    const auto slope = hn::Set(d, run.slope_N);
    const auto limit = hn::Set(d, lowest);
    auto least = limit;
    int node = run.first;
    for (; node + lanes <= run.end; node += lanes) {
        const auto now = hn::Add(anchor, hn::Mul(slope, hn::LoadU(d, elongation + node)));
        const auto increment = hn::Mul(way, hn::Sub(now, hn::LoadU(d, before_m + node)));
        least = hn::Min(least, increment);
    }
    if (!hn::AllTrue(d, hn::Ge(least, limit))) return false;
    for (; node < run.end; ++node) {
        const double increment_m = run.anchor_m + run.slope_N * elongation[node] - before_m[node];
        if (direction * increment_m < lowest) return false;
    }
    return true;
}

void write_nodes(const SlidingRun& run, double* HWY_RESTRICT tension_N, double* HWY_RESTRICT displacement_m) {
    const hn::ScalableTag<double> d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const double* HWY_RESTRICT ratio = run.ratio;
    const double* HWY_RESTRICT elongation = run.elongation_m_per_N;
    const auto scale = hn::Set(d, run.scale_N);
    const auto anchor = hn::Set(d, run.anchor_m);
    const auto slope = hn::Set(d, run.slope_N);
    int node = run.first;
    for (; node + lanes <= run.end; node += lanes) {
        hn::StoreU(hn::Mul(scale, hn::LoadU(d, ratio + node)), d, tension_N + node);
        hn::StoreU(hn::Add(anchor, hn::Mul(slope, hn::LoadU(d, elongation + node))), d,
                   displacement_m + node);
    }
    for (; node < run.end; ++node) {
        tension_N[node] = run.scale_N * ratio[node];
        displacement_m[node] = run.anchor_m + run.slope_N * elongation[node];
    }
}

}  // namespace capstan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace capstan {

HWY_EXPORT(every_node_moves);
HWY_EXPORT(write_nodes);

namespace {

// Rounding of displacements of up to a metre, with three digits to spare.
constexpr double displacement_rounding_m = 1e-12;

// The paper's check, for its own figures.
bool every_segment_moves_in_the_mean(const SlidingRun& run, double direction, const double* before_m) {
    const auto increment_m = [&](int node) {
        return run.anchor_m + run.slope_N * run.elongation_m_per_N[node] - before_m[node];
    };
    for (int node = run.first; node + 1 < run.end; ++node) {
        if (direction * (increment_m(node) + increment_m(node + 1)) < -displacement_rounding_m) return false;
    }
    return true;
}

}  // namespace

SlidingRun proximal_run(const StepView& view, const Candidate& candidate) {
    const MotionPattern& pattern = candidate.pattern;
    const SideTable& table = view.tables.proximal(sign(pattern.proximal_direction));
    return {0,
            pattern.proximal_moving_nodes,
            candidate.proximal.tension_N,
            candidate.proximal.displacement_m,
            candidate.proximal.tension_N,
            table.tension_ratio.data(),
            table.elongation_m_per_N.data()};
}

SlidingRun distal_run(const StepView& view, const Candidate& candidate) {
    const MotionPattern& pattern = candidate.pattern;
    const SideTable& table = view.tables.distal(sign(pattern.distal_direction));
    // In mass motion the proximal run has all nodes already.
    return {std::max(pattern.proximal_moving_nodes, view.nodes() - pattern.distal_moving_nodes),
            view.nodes(),
            candidate.distal.tension_N,
            candidate.distal.displacement_m,
            -candidate.distal.tension_N,
            table.tension_ratio.data(),
            table.elongation_m_per_N.data()};
}

bool moves_along(const SlidingRun& run, Direction direction, const StepView& view) {
    if (run.first >= run.end) return true;
    const double* before_m = view.before.displacement_m.data();
    switch (view.rules.check) {
        case VelocityCheck::every_node:
            return HWY_DYNAMIC_DISPATCH(every_node_moves)(run, sign(direction), before_m,
                                                          -displacement_rounding_m);
        case VelocityCheck::segment_mean:
            return every_segment_moves_in_the_mean(run, sign(direction), before_m);
    }
    return false;
}

void write_run(const SlidingRun& run, CableState& state) {
    if (run.first >= run.end) return;
    HWY_DYNAMIC_DISPATCH(write_nodes)(run, state.tension_N.data(), state.displacement_m.data());
}

}  // namespace capstan
#endif
