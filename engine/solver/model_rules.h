#pragma once

namespace capstan {

/// How much a segment stretches under the tensions of its two nodes (engine/README.md, E2 and E3).
enum class ElongationRule {
    /// w (T_i + T_{i+1}) / 2 for every segment, moving or not: no gap when a front passes. Ours.
    mean_tension,
    /// E2's exponential for sliding segments, the mean tension (E3) next to a resting node. The paper's.
    exponential_and_mean,
};

/// Which friction coefficient holds a segment next to a resting node (E4).
enum class StictionRule {
    /// mu_s if the segment was at rest in the step before, mu_d if it slid. Ours.
    remembers_sliding,
    /// mu_s always. The paper's.
    memoryless,
};

/// What a solution must show before it counts (E5).
enum class VelocityCheck {
    every_node,    ///< each moving node moved its pattern's way. Ours.
    segment_mean,  ///< the mean of each sliding segment's two nodes did. The paper's.
};

/// The readings of the model on which the paper is silent, ambiguous or wrong; engine/README.md tells why.
struct ModelRules {
    ElongationRule elongation = ElongationRule::mean_tension;
    StictionRule stiction = StictionRule::remembers_sliding;
    VelocityCheck check = VelocityCheck::every_node;

    static constexpr ModelRules consistent() { return {}; }
    static constexpr ModelRules paper() {
        return {ElongationRule::exponential_and_mean, StictionRule::memoryless, VelocityCheck::segment_mean};
    }
};

}  // namespace capstan
