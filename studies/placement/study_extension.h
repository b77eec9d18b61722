#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "capstan/placement/study_run.h"

namespace capstan {

/// With 1 - `alpha` certainty for each target no candidate is better than the best of its count by more than
/// this [N]: the largest over all targets, which are the noise levels, questions and numbers of sensors. Zero
/// if every count has one candidate only; infinite after one repetition.
double unresolved_N(storage::Database& database, std::int64_t study_id, double alpha);

/// A stored study and the plan that its configuration describes.
struct StudyToExtend {
    std::int64_t study_id = 0;
    StudyPlan plan;

    StudyPlan with_repetitions(int repetitions) const;
};

struct ExtensionOutcome {
    RunOutcome run;       ///< of the larger study; its study_id is the extended one's if enough
    int repetitions = 0;  ///< that the study now has
    std::optional<double> unresolved_N;  ///< until_resolved only: what is left open
};

/// Runs the study with more repetitions, beside the one that is there. Its first repetitions are the draws of
/// the smaller one, and it has the bits of a study run with that number from the start: whatever is summed
/// over repetitions, and the weights of the W methods, is worked out for all of them again. A larger study
/// that was begun before is gone on with. Throws InvalidInput if `repetitions` are no more than there are.
ExtensionOutcome extend_study(storage::Database& database, const StudyToExtend& study, int repetitions,
                              const std::string& program_version, const RunOptions& options);

struct Resolution {
    double tolerance_N = 0.0;
    int max_repetitions = 128000;
    std::function<void(int repetitions, double unresolved_N)> on_look;  ///< may be empty
};

/// Doubles the repetitions until unresolved_N() is within the tolerance on all targets. Each check has
/// half the error probability of the one before, so that all checks together hold with 95%. Only the last of
/// the studies that it runs is kept.
ExtensionOutcome extend_until_resolved(storage::Database& database, const StudyToExtend& study,
                                       const Resolution& resolution, const std::string& program_version,
                                       const RunOptions& options);

}  // namespace capstan
