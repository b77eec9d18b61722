#pragma once

#include <string>
#include <vector>

#include "capstan/placement/placement_scope.h"

namespace capstan {

/// A layout with the fusion method that suits it best, and what it costs in error [N].
struct JudgedLayout {
    int candidate = -1;      ///< its number among those scored
    std::string how;         ///< "optimum", "runner_up", "even", "distal", "both", "greedy_forward", ...
    std::vector<int> nodes;  // from 0
    std::string method;
    double searched_N = 0.0;      ///< on the draws on which it was chosen: too good for an optimum
    IntervalEstimate fresh;       ///< on draws that no choice has seen
    IntervalEstimate difference;  ///< to the optimum of the same count, fresh, paired
    double after_loss_N = 0.0;    ///< without the sensor that is worst to lose; infinite: none is left
    double cost = 0.0;
    std::vector<std::string> breaks;  ///< keys of the constraints that it does not satisfy
};

/// A candidate that the draws cannot tell from the optimum.
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
    double optimism_N = 0.0;  ///< fresh error less that of the search: what the best of many owes to luck
    std::vector<JudgedLayout> runners_up;  ///< the next best sets, best first
    std::vector<JudgedLayout> beside;      ///< families, greedy choices, D-optimal
    /// Candidates that are not worse with certainty (95%, all together); the truly best is one of these or
    /// the optimum. Best first.
    std::vector<IndifferentLayout> indifferent;
    /// With 95% certainty no candidate is better than the optimum by more than this [N].
    double at_most_better_N = 0.0;
    /// Greedy search only: no layout of that count tells more than the D-optimal one beside it by more than
    /// this [nats]; 0: it is proven to be the D-optimal one.
    double d_optimal_gap_nats = 0.0;
};

/// The answer to one question.
struct ScopeAnswer {
    std::string scope;                ///< "regime", "minimax_regret" or "duty_cycle"
    std::string regime;               ///< "regime" only
    std::vector<CountAnswer> counts;  ///< those for which a layout is allowed
    int recommended_count = 0;        ///< from where no larger count gains `worthwhile_gain_N` a sensor
};

enum class SearchKind { exhaustive, greedy };

struct PlacementTimes {
    double score_s = 0.0;  ///< wall time of scoring all candidates
    double fresh_s = 0.0;  ///< wall time of scoring the chosen ones on fresh draws
    double wall_s = 0.0;
};

struct PlacementAnswer {
    SearchKind search = SearchKind::exhaustive;
    std::string noise;
    int layouts = 0;      ///< sensor sets that were scored
    int candidates = 0;   ///< times fusion methods
    int repetitions = 0;  ///< of the search; as many fresh ones
    std::vector<ScopeAnswer> scopes;
    PlacementTimes times;
};

/// The smallest count from which no larger one gains `worthwhile_gain_N` per sensor added; 0 without counts.
int count_where_gain_flattens(const std::vector<CountAnswer>& counts, double worthwhile_gain_N);

}  // namespace capstan
