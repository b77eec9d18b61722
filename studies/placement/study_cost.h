#pragma once

#include <span>
#include <vector>

#include "capstan/plan/study_plan.h"

namespace capstan {

struct PilotOptions {
    double seconds = 5.0;   ///< processor time to spend; at least one part of each cable length is timed
    int repetitions = 200;  ///< of a timed part, at most those of the plan
};

/// What studies will cost, counted and, from a pilot on one processor of this machine, predicted.
struct StudyCost {
    int studies = 0;
    int parts = 0;           ///< instants x noise levels, over all studies: the most shards there can be
    long long cells = 0;     ///< parts x sensor sets x methods
    long long readings = 0;  ///< parts x repetitions x nodes
    int repetitions = 0;     ///< of each part
    int pilot_parts = 0;     ///< that were timed
    int pilot_repetitions = 0;

    double processor_s = 0.0;          ///< one run on one processor of this machine
    double shard_preparation_s = 0.0;  ///< once more for every shard: true motions, tables
    double weight_part_s = 0.0;        ///< to solve one part's readings again for the weights of others

    /// Half the width of a cell's 95% interval of its mean error, at the plan's repetitions.
    double median_half_width_N = 0.0;
    double largest_half_width_N = 0.0;

    /// Processor time of all shards together: what one run costs, and what each shard does again.
    double processor_s_with(std::span<const StudyPlan> plans, int shards) const;
};

/// How often a shard has to solve the readings of a part that another shard owns, for the weights that they
/// give.
int parts_solved_again(std::span<const StudyPlan> plans, int shards);

/// Throws InvalidInput if a plan has problems. `plans` is not empty.
StudyCost predict_cost(std::span<const StudyPlan> plans, const PilotOptions& options);

}  // namespace capstan
