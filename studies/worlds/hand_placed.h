#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include "capstan/storage/database.h"
#include "capstan/worlds/error_table.h"
#include "capstan/worlds/world_study.h"

namespace capstan {

/// What a study over worlds says of sensors that a user placed, from the worlds that its own errors come
/// from.
struct HandPlaced {
    Candidate set;
    bool is_allowed = false;  ///< by [placement]
    Expected expected;
    Estimated gain_over_none;          ///< no sensor - placed, paired
    Estimated worse_than_recommended;  ///< placed - recommended (no sensor where nothing is), paired
    /// Whether a paired t test at 5% tells it from the recommended set.
    bool is_distinguished() const {
        return worse_than_recommended.low_N > 0.0 || worse_than_recommended.high_N < 0.0;
    }
};

/// Judges any set of the sensors on offer through the table of errors of a complete stored study: a set of
/// the study has the study's bits. For any thread; nothing is stored.
class HandPlacer {
  public:
    HandPlacer(storage::Database& database, std::int64_t study_id, const StudyPlan& plan);

    const WorldAnswer& answer() const { return answer_; }
    /// `sensors`: indices of the answer's offers, in any order. Throws InvalidInput if there is none, one
    /// twice, or one that is not on offer.
    HandPlaced judge(std::vector<int> sensors);

  private:
    std::mutex mutex_;
    ErrorTable table_;
    WorldAnswer answer_;
};

}  // namespace capstan
