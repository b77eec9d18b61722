#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "capstan/import/finding.h"
#include "capstan/import/section.h"
#include "capstan/recording/problem_list.h"

namespace capstan::imports {

/// One uninterrupted stretch of a log with the columns of the mapping's channels in it.
struct LogRun {
    const RunMapping* mapping = nullptr;  ///< null: the mapping lists no runs
    std::vector<std::filesystem::path> files;
    std::vector<Source> sources;  ///< one per channel of the mapping, in its order
    RowRange rows;
    const logs::LogColumn* run_column = nullptr;
    double run_value = 0.0;  ///< of `run_column`
    double start_s = 0.0;    ///< time of the stretch's first row
};

/// All runs that a mapping finds in files, with the logs that their sources point into.
struct LogRuns {
    std::vector<std::unique_ptr<logs::Log>> logs;
    std::vector<LogRun> runs;
    std::vector<Finding> findings;  ///< what could not be read
};

/// Reads the files and finds the mapping's columns in them. What does not fit goes into `problems`: a file
/// that no run names, a column that no table has (with the columns that are there), times that cannot be
/// found. `on_progress` gets the fraction of all files' bytes that were read.
LogRuns read_log_runs(const std::vector<std::filesystem::path>& files, const Mapping& mapping,
                      const std::function<void(double)>& on_progress, ProblemList& problems);

}  // namespace capstan::imports
