#include "capstan/placement/repetition_profiles.h"

#include <algorithm>

namespace capstan {

RepetitionProfiles::RepetitionProfiles(const PreparedScenario& scenario, int nodes)
    : scenario_(scenario),
      nodes_(nodes),
      unknown_N_(static_cast<std::size_t>(nodes) * padded_nodes(nodes)),
      known_N_(unknown_N_.size()),
      directions_(nodes),
      verified_(nodes),
      known_usable_(nodes) {}

void RepetitionProfiles::fill(const SolvedReadings& solved, int repetition) {
    for (int sensor = 0; sensor < nodes_; ++sensor) {
        const std::size_t slot = solved.at(repetition, sensor);
        const double reading_N = solved.reading_N[slot];
        const SensorBranch& branch = scenario_.estimator.branches(sensor)[solved.branch[slot]];
        write_profile(branch, reading_N, unknown_N_, sensor);
        directions_[sensor] = branch.directions;
        verified_[sensor] = branch.verified;
        const auto& known = scenario_.known_branch[sensor];
        known_usable_[sensor] = known.has_value();
        if (known) {
            write_profile(*known, reading_N, known_N_, sensor);
        } else {
            std::copy(scenario_.previous.tension_N.begin(), scenario_.previous.tension_N.end(),
                      known_N_.begin() + static_cast<std::ptrdiff_t>(sensor) * padded_nodes(nodes_));
        }
    }
}

void RepetitionProfiles::write_profile(const SensorBranch& branch, double reading_N,
                                       std::vector<double>& all_N, int sensor) {
    double* profile_N = all_N.data() + static_cast<std::size_t>(sensor) * padded_nodes(nodes_);
    for (int node = 0; node < nodes_; ++node) profile_N[node] = branch.tension_N(node, reading_N);
}

}  // namespace capstan
