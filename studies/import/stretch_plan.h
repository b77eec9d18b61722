#pragma once

#include <map>

#include "capstan/import/aligned_rows.h"
#include "capstan/import/survey.h"

namespace capstan::imports {

/// A log's run after its repairs: which pieces of it become runs of the recording.
struct StretchPlan {
    std::vector<ChannelSurvey> surveys;  ///< one per source
    std::vector<Piece> pieces;
    double sample_rate_Hz = 0.0;  ///< of the samples that the pieces give
};

/// Surveys a run's channels, unwraps their counters (the sources' `wraps_at`), and cuts the run at its gaps.
/// What was found is added to `findings`. `number`: the run's number for messages, from 1; 0: the log has one
/// run.
StretchPlan plan_stretch(LogRun& run, std::size_t index, const Mapping& mapping,
                         std::vector<Finding>& findings);

}  // namespace capstan::imports
