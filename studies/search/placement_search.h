#pragma once

#include <vector>

#include "capstan/placement/placement_questions.h"
#include "capstan/plan/placement_constraints.h"
#include "capstan/search/placement_answer.h"
#include "capstan/search/scored_draws.h"

namespace capstan {

/// Finds, among the candidates that the constraints allow, the optimum of each count for a question, and the
/// layouts with which it is compared.
class PlacementSearch {
  public:
    /// All arguments must outlive it. `alpha`: chance that any of the simultaneous intervals is wrong.
    PlacementSearch(const PreparedStudy& study, int noise_index, const CandidateList& candidates,
                    const ScoredDraws& draws, double alpha);

    /// Every regime, minimax regret across regimes, and the duty cycle.
    std::vector<PlacementScope> scopes() const;
    /// Without the fields that independent draws fill.
    ScopeAnswer answer(const PlacementScope& scope, int runners_up) const;

    /// The smallest error after the worst loss of one sensor, over all layouts that the other constraints
    /// allow.
    double min_after_loss_N(const PlacementScope& scope) const;

  private:
    struct Ranked {
        int candidate = -1;
        double objective_N = 0.0;
    };
    std::vector<double> objectives_N(const PlacementScope& scope) const;
    std::vector<Ranked> ranked_sets(const std::vector<double>& objective_N, int sensors) const;
    int best_method(const std::vector<double>& objective_N, int subset) const;
    double after_loss_N(const std::vector<double>& objective_N, int candidate) const;
    bool survives_loss(const std::vector<double>& objective_N, int candidate) const;
    std::vector<int> greedy_forward(const std::vector<double>& objective_N) const;
    std::vector<int> greedy_backward(const std::vector<double>& objective_N) const;
    std::vector<int> max_information(const PlacementScope& scope) const;
    JudgedLayout judged(const std::vector<double>& objective_N, const std::string& how, int candidate) const;
    void compare_all(const PlacementScope& scope, const std::vector<double>& objective_N,
                     CountAnswer& answer) const;

    const PreparedStudy& study_;
    int noise_index_;
    const CandidateList& candidates_;
    const ScoredDraws& draws_;
    double alpha_;
    PlacementConstraints constraints_;
    ScenarioFractions fractions_;
    std::vector<std::uint8_t> allowed_;  // subsets
};

}  // namespace capstan
