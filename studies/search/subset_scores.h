#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "capstan/placement/prepared_study.h"
#include "capstan/placement/single_sensor_stage.h"
#include "capstan/plan/placement_plan.h"
#include "capstan/search/sensor_subsets.h"

namespace capstan {

/// A candidate is a sensor set with a fusion method; its number is subset * methods + method. The empty set
/// is there and has no scores.
struct CandidateList {
    const SensorSubsets& subsets;
    std::vector<const FusionMethod*> methods;  ///< none that is told the direction; catalogue order
    /// candidates: 0 where no score is wanted; empty: all are
    std::vector<std::uint8_t> wanted;

    int count() const { return subsets.count() * static_cast<int>(methods.size()); }
    int of(int subset, int method) const { return subset * static_cast<int>(methods.size()) + method; }
    int subset(int candidate) const { return candidate / static_cast<int>(methods.size()); }
    int method(int candidate) const { return candidate % static_cast<int>(methods.size()); }
    bool wants(int candidate) const { return wanted.empty() || wanted[candidate] != 0; }
};

/// Consecutive repetitions: the unit of threads, of sums and of paired differences. All blocks have one size,
/// but the last one is shorter where the repetitions do not divide evenly.
struct DrawBlocks {
    int repetitions = 0;
    int block_size = 1;

    /// So many repetitions, in the blocks of a study.
    static DrawBlocks for_repetitions(int repetitions);
    /// With the last block filled up, so that more blocks can follow and the old ones stay what they were.
    DrawBlocks filled_up() const { return {count() * block_size, block_size}; }
    DrawBlocks doubled() const { return {2 * repetitions, block_size}; }

    int count() const { return (repetitions + block_size - 1) / block_size; }
    int first(int block) const { return block * block_size; }
    int end(int block) const { return std::min(first(block) + block_size, repetitions); }
    int size(int block) const { return end(block) - first(block); }
};

/// Errors of all candidates in one scenario, block by block [N].
struct BlockErrors {
    int width = 1;                   ///< numbers to a candidate: 1, or one for each node
    std::vector<double> sum_N;       // blocks x candidates x width: summed over the block's repetitions
    std::vector<float> quantile_of;  // repetitions x candidates: only for a quantile objective
};

/// The inputs of scoring a scenario besides its readings.
struct ScoringTask {
    const PreparedStudy& study;
    StudyPoint point;
    std::span<const double> weight;  // nodes: of the W methods
    const CandidateList& candidates;
    PlacementObjective objective;
    DrawBlocks blocks;
};

/// The cost of scoring a draw, in those of the search: on independent draws only chosen layouts are scored.
double work_of_draw(std::uint32_t first_draw);

/// Scores blocks `first_block` on; those before stay in `errors`. Each reading is solved once and every set's
/// sums are those of a smaller set and one sensor more. `solved` holds the repetitions of all blocks.
/// Notes the work of each draw.
void score_blocks(const ScoringTask& task, const SolvedReadings& solved, int first_block, int jobs,
                  BlockErrors& errors);

/// Bytes that the errors of one scenario take.
double block_error_bytes(double candidates, PlacementObjective objective, const DrawBlocks& blocks,
                         int nodes);

}  // namespace capstan
