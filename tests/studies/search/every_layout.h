#pragma once
// All layouts of a plan, scored: what tests of the search compare with.

#include <numeric>

#include "capstan/search/placement_search.h"
#include "capstan/search/sensor_placement.h"
#include "paper_plan.h"

namespace capstan::test {

inline PlacementOptions alone() {
    PlacementOptions options;
    options.jobs = 1;
    return options;
}

/// How often an interval covered the truth, over so many studies with seeds of their own.
inline constexpr int coverage_studies = 400;
struct Tally {
    int covered = 0;
    int all = 0;
    double fraction() const { return static_cast<double>(covered) / all; }
};

/// A plan's candidates and their errors on its own draws.
struct EveryLayout {
    explicit EveryLayout(const StudyPlan& plan, int noise_index = 0, int jobs = 1)
        : study(prepare(plan)),
          subsets(all_nodes(study.nodes()), study.nodes()),
          candidates{subsets, methods_of(study), {}},
          weights(ScoredDraws::weights(study, noise_index, jobs)),
          draws(study, noise_index, 0, candidates, plan.placement.objective) {}

    static std::vector<int> all_nodes(int count) {
        std::vector<int> nodes(count);
        std::iota(nodes.begin(), nodes.end(), 0);
        return nodes;
    }
    static std::vector<const FusionMethod*> methods_of(const PreparedStudy& study) {
        std::vector<const FusionMethod*> methods;
        for (const FusionMethod* method : study.methods) {
            if (method->knowledge != Knowledge::direction_known) methods.push_back(method);
        }
        return methods;
    }
    int candidate(const std::vector<int>& nodes, std::string_view method) const {
        for (std::size_t m = 0; m < candidates.methods.size(); ++m) {
            if (candidates.methods[m]->name == method) {
                return candidates.of(subsets.find(nodes), static_cast<int>(m));
            }
        }
        return -1;
    }

    PreparedStudy study;
    SensorSubsets subsets;
    CandidateList candidates;
    std::vector<std::vector<double>> weights;
    ScoredDraws draws;
};

}  // namespace capstan::test
