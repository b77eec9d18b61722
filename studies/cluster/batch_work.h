#pragma once

#include "capstan/cluster/study_directory.h"
#include "capstan/cluster/worker.h"
#include "capstan/units/result_units.h"

namespace capstan::cluster {

/// The commands that can be a batch: each unit is one command, whose answer (JSON) is its result.
inline constexpr const char* batch_commands[] = {"diagnose", "gap-trial", "place", "sensitivity"};

/// Commands beside each other: shard n is the command for input n, in a process of its own. Its result is
/// what the command prints, byte by byte, so that it has the bits of the command by itself. A command that
/// refuses its input (exit code 2) has the refusal as its result, because it would refuse it everywhere; one
/// that fails in another way is not done.
units::ResultUnits units_of(const StudyDirectory& directory);
units::Result run_unit(const StudyDirectory& directory, int unit, const WorkOptions& options,
                       const std::function<bool()>& is_unwanted);

}  // namespace capstan::cluster
