#pragma once

#include <string>
#include <vector>

#include "capstan/search/placement_scope.h"

namespace capstan {

/// A layout with its best fusion method, and its errors [N].
struct JudgedLayout {
    int candidate = -1;      ///< its number among the scored candidates
    std::string how;         ///< "optimum", "runner_up", "even", "distal", "both", "greedy_forward", ...
    std::vector<int> nodes;  // from 0
    std::string method;
    double searched_N = 0.0;       ///< on the draws that chose it: optimistic for an optimum
    IntervalEstimate independent;  ///< on independent draws
    IntervalEstimate difference;   ///< to the optimum of the same count, paired, independent draws
    double after_loss_N = 0.0;     ///< after the worst loss of one sensor; infinite: none is left
    double cost = 0.0;
    std::vector<std::string> breaks;  ///< keys of the constraints that it violates
};

/// A candidate that is not significantly worse than the optimum of its count.
struct IndifferentLayout {
    std::vector<int> nodes;  // from 0
    std::string method;
    IntervalEstimate difference;  ///< to the optimum, simultaneous over all candidates of the count
};

/// The answer for one number of sensors.
struct CountAnswer {
    int sensors = 0;
    int allowed_layouts = 0;
    JudgedLayout optimum;
    double optimism_N = 0.0;               ///< error on independent draws less that of the search
    std::vector<JudgedLayout> runners_up;  ///< the next best sets, best first
    std::vector<JudgedLayout> beside;      ///< families, greedy choices, D-optimal
    /// Candidates that are not significantly worse: paired t tests at the 5% level, Bonferroni-corrected over
    /// all candidates of the count. With 95% certainty the truly best is one of these or the optimum. Best
    /// first.
    std::vector<IndifferentLayout> indifferent;
    /// With 95% certainty no candidate is better than the optimum by more than this [N].
    double at_most_better_N = 0.0;
    /// Greedy search only: no layout of that count has more information than the D-optimal one beside it by
    /// more than this [nats]; 0: it is proven to be D-optimal.
    double d_optimal_gap_nats = 0.0;
};

/// The answer to one question.
struct ScopeAnswer {
    std::string scope;                ///< "regime", "minimax_regret" or "duty_cycle"
    std::string regime;               ///< "regime" only
    std::vector<CountAnswer> counts;  ///< the counts with an allowed layout
    int recommended_count = 0;

    /// Sets recommended_count from the errors on independent draws: count_where_gain_flattens().
    void recommend_count(double worthwhile_gain_N);
};

enum class SearchKind { exhaustive, greedy };

struct PlacementTimes {
    double score_s = 0.0;        ///< wall time of scoring all candidates
    double independent_s = 0.0;  ///< wall time of scoring the chosen ones on independent draws
    double wall_s = 0.0;
};

struct PlacementAnswer {
    SearchKind search = SearchKind::exhaustive;
    std::string noise;
    int layouts = 0;      ///< sensor sets that were scored
    int candidates = 0;   ///< sensor sets times fusion methods
    int repetitions = 0;  ///< of the search; the independent draws are as many
    std::vector<ScopeAnswer> scopes;
    PlacementTimes times;
};

}  // namespace capstan
