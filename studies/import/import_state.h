#pragma once
// What an import knows before its samples are written; shared by its steps.

#include <nlohmann/json.hpp>

#include "capstan/import/importer.h"
#include "capstan/import/stretch_plan.h"
#include "capstan/recording/problem_list.h"

namespace capstan::imports {

struct ImportState {
    const Mapping& mapping;
    const ImportOptions& options;
    ProblemList problems{};
    LogRuns logs{};
    std::vector<StretchPlan> plans{};  ///< by run of the log
    std::vector<Piece> pieces{};       ///< runs of the recording
    std::vector<double> starts_s{};    ///< of the pieces, from the first one's
    std::vector<std::size_t> kept{};   ///< channels of the mapping that are not left out
    ImportReport report{};

    bool is_angle(std::size_t kept_channel) const {
        return report.channels[kept_channel].ends_with("_angle");
    }
};

/// Surveys every run of the log and cuts it into pieces. Findings are noted in `findings`.
void plan_runs(ImportState& state, std::vector<Finding>& findings);

/// Numbers the pieces as runs of the recording.
void number_runs(ImportState& state);

/// Shifts channels of other clocks to that of the first angle, or of the first channel, by what their motion
/// shows. Then clock after clock is aligned to those that are: an angle that follows another angle knows its
/// offset best, and speaks for its clock; a torque lags behind angles for other reasons too, so it comes
/// last. A clock whose offset the log does not tell stays as it is, which is named. Offsets that the mapping
/// states are kept. An angle that is late within the first clock is named and
/// left.
void align_clocks(ImportState& state);

/// The recording's description.
nlohmann::ordered_json imported_sidecar(const ImportState& state);

/// The recording with at most `preview_samples` of each run; counts the samples of `report.runs`. Throws
/// InvalidInput where the mapping's [recording] is wrong.
Recording preview_recording(ImportState& state);

}  // namespace capstan::imports
