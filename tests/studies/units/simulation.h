#pragma once

#include <cstdint>
#include <string>

namespace capstan::units {

/// What one seed gave. The same seed gives the same schedule, step by step.
struct Schedule {
    std::string problem{};  ///< empty: every unit is in the merged result once, with its right value
    std::string kind{};     ///< what the seed drew, for people
    long steps = 0;         ///< operations on the shared folder
    int faults = 0;         ///< that were put into it
};

/// Simulates a study of a few units from its submission to the merged result: the real worker, lease, record
/// and merge (capstan/units), on a shared folder, a clock, machines and a scheduler that are simulated. Each
/// worker is stopped before and after every operation, and what goes on next is drawn.
///
/// One seed in four has no faults: then each unit must be computed once. The others draw from: an operation
/// that fails, before or after it had its effect; an answer that was lost, so that the request is repeated; a
/// look that shows the folder as it was up to a minute ago; a bit of a file that flips; a disk that loses
/// what was written last; a worker that is killed, stopped for minutes, or ten times slower; a disk clock
/// that jumps; a task that the scheduler loses, starts twice or starts again. From some time on nothing fails
/// any more, and someone starts workers while the result is not there: then it must come.
Schedule simulate(std::uint64_t seed);

}  // namespace capstan::units
