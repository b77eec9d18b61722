#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "capstan/units/shared_folder.h"

namespace capstan::units {

enum class WorkEnd { complete, stopped, failed };

/// What the units are. Two workers that compute the same unit give the same bits.
class UnitWork {
  public:
    struct Computed {
        WorkEnd end = WorkEnd::stopped;
        std::string file;      ///< with the result
        std::string sha256{};  ///< of that file; empty: it holds its own hashes and the next too
        std::string computed_with{};
    };
    struct Merged {
        WorkEnd end = WorkEnd::stopped;
        std::vector<int>
            damaged{};  ///< units whose results are not what their records say; nothing was merged
    };

    virtual ~UnitWork() = default;
    virtual int count() const = 0;
    virtual bool is_merged() = 0;
    virtual bool stop_requested() const = 0;

    /// Whether a unit without a record is done, because its file was made by hand.
    virtual bool is_complete_by_hand(int) { return false; }

    /// Computes a unit, or goes on with it; `is_second`: another worker may be at it, so into a file of its
    /// own. Ends soon after `is_unwanted`, which may be called from another thread. An exception ends the
    /// worker; `failed` lets it go on with other units.
    virtual Computed compute(int unit, bool is_second, const std::function<bool()>& is_unwanted) = 0;

    /// The file of a second worker that was slower.
    virtual void discard(const std::string& file) = 0;

    /// Joins the results of all units, or says which are damaged.
    virtual Merged merge() = 0;
};

struct WorkerOptions {
    double late_after_s = 30.0;  ///< a unit is never late before that
    double late_factor = 3.0;    ///< nor before so many times as long as the median unit took
    std::function<void(const std::string&)> say;  ///< a line of the log
};

/// Works on the units, each under a lease, so that any number of workers on any machines can share them:
///
/// - with `own`: that unit, whoever held it before (a scheduler starts a task again when its node has
/// failed);
///   without, one free unit after the other;
/// - then, where every unit has been begun: waits beside one that runs, and computes it once more if it is
///   late or its worker has died. Two workers on one unit write two files with the same bits; the first that
///   ends counts;
/// - then, where every unit is done: merges.
///
/// Of each unfinished unit only one worker waits. Returns failed when a unit failed here.
WorkEnd work(SharedFolder& folder, UnitWork& work, std::optional<int> own, const WorkerOptions& options);

/// Merges unless that is done; waits for a worker that merges now. A unit whose result is damaged is computed
/// again, at most three times. Throws std::runtime_error where that did not help.
WorkEnd merge(SharedFolder& folder, UnitWork& work, const WorkerOptions& options);

}  // namespace capstan::units
