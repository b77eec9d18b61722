#pragma once

#include <span>
#include <string>
#include <vector>

#include "capstan/placement/study_run.h"

namespace capstan {

/// One of several runs that together make the studies of a configuration.
struct Shard {
    int number = 1;  ///< 1 to count
    int count = 1;
};

struct StudySize {
    int noise_levels = 0;
    int instants = 0;
};

StudySize size_of(const StudyPlan& plan);

/// Who owns what. It depends on nothing but the sizes of the studies and the number of shards.
///
/// A part is one instant at one noise level. Parts of a study's noise level share the weights of the W
/// methods, so they stay together: noise levels, counted through all studies, are dealt out like cards,
/// because neighbours cost about alike. Only when there are fewer of them than shards, single parts are dealt
/// out, and weights are then worked out by more than one shard.
class Deal {
  public:
    Deal(const std::vector<StudySize>& studies, int shards);

    /// Number of the owning shard, from 1; study from 0.
    int owner(std::size_t study, int noise_index, int scenario_index) const;

  private:
    int shards_;
    std::vector<StudySize> studies_;
    std::vector<int> noise_levels_before_;  // studies
    std::vector<int> parts_before_;         // studies
    bool keeps_noise_levels_together_ = false;
};

Deal deal_out(std::span<const StudyPlan> plans, int shards);

/// Parts of all studies, which is also the largest useful number of shards.
int parts_of(std::span<const StudyPlan> plans);

/// Throws InvalidInput if the shard would own nothing.
void require_useful(std::span<const StudyPlan> plans, const Shard& shard);

/// "shard 2 of 8"
std::string words_of(const Shard& shard);

struct ShardOutcome {
    RunEnd end = RunEnd::complete;
    StudyTimes times;
};

/// Runs a shard in a file of its own, opened with Journal::rollback; where the file is that shard already,
/// goes on where it was. The studies in it stay 'running': merge_shards() concludes them. Throws InvalidInput
/// if a plan has problems or the shard would own nothing, storage::Error if the file is something else.
ShardOutcome run_shard(storage::Database& database, std::span<const StudyPlan> plans, const Shard& shard,
                       const std::string& program_version, const RunOptions& options);

}  // namespace capstan
