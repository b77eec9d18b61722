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

/// A study in many shards on the nodes of a scheduler, each of which runs one task after the other; nothing
/// else fails.
struct Cluster {
    int units = 2500;
    int nodes = 4;
    double unit_s = 60.0;         ///< in the mean; from half of it to half as much again
    double slow_factor = 10.0;    ///< one node is so much slower
    double node_dies_at_s = 0.0;  ///< another one, whose task the scheduler starts again; 0: none
};
struct ClusterRun {
    std::string problem{};
    double wall_s = 0.0;   ///< until the merged result is there
    double ideal_s = 0.0;  ///< all the work, divided by what the nodes that live can do
};
ClusterRun simulate_cluster(const Cluster& cluster, std::uint64_t seed);

}  // namespace capstan::units
