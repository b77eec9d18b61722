#pragma once

#include <functional>
#include <set>

#include "capstan/placement/prepared_study.h"
#include "capstan/placement/study_run.h"
#include "capstan/storage/database.h"

namespace capstan {

/// Work units of one stored study that are to be run.
struct UnitsToRun {
    std::int64_t study_id = 0;
    std::set<int> units;              // unit_index, of units that are not done
    std::function<void()> on_stored;  ///< called after every stored unit; may be empty
    /// Another program may store the same unit first (a task that was started again while the first still
    /// ran). Both have the same bits, so that is not an error.
    bool shared_with_others = false;
};

/// Numbers of the units of an instant at a noise level, as describe() lays them out.
int single_sensor_unit(const PreparedStudy& study, int noise_index, int scenario_index);
int fusion_unit(const PreparedStudy& study, int noise_index, int scenario_index);

/// Runs the units and stores each in a transaction of its own. Of what else they need (the single-sensor
/// errors that give the weights) only that is solved again, to the same bits, and not written. Adds to
/// `times`. Returns stopped when options.stop was set; the rest is then not done.
RunEnd run_units(storage::Database& database, const PreparedStudy& study, UnitsToRun work,
                 const RunOptions& options, StudyTimes& times);

}  // namespace capstan
