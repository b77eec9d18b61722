#include "capstan/search/placement_search.h"

#include <algorithm>
#include <limits>

#include "capstan/search/information_choice.h"

namespace capstan {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

PlacementSearch::PlacementSearch(const PreparedStudy& study, int noise_index, const CandidateList& candidates,
                                 const ScoredDraws& draws, double alpha)
    : study_(study),
      noise_index_(noise_index),
      candidates_(candidates),
      draws_(draws),
      alpha_(alpha),
      constraints_(study.plan.placement, study.nodes()),
      fractions_(scenario_fractions(study)),
      allowed_(candidates.subsets.count(), 0) {
    for (int s = 1; s < candidates.subsets.count(); ++s) {
        allowed_[s] = constraints_.allow(candidates.subsets.nodes_of(s));
    }
}

std::vector<double> PlacementSearch::objectives_N(const PlacementScope& scope) const {
    std::vector<double> objective_N(candidates_.count(), infinity);
    const int first = candidates_.of(1, 0);
    for (int c = first; c < candidates_.count(); ++c)
        objective_N[c] = scope.objective_N(draws_.scenarios(), c);
    return objective_N;
}

int PlacementSearch::best_method(const std::vector<double>& objective_N, int subset) const {
    int best = candidates_.of(subset, 0);
    for (std::size_t m = 1; m < candidates_.methods.size(); ++m) {
        const int candidate = candidates_.of(subset, static_cast<int>(m));
        if (objective_N[candidate] < objective_N[best]) best = candidate;
    }
    return best;
}

double PlacementSearch::after_loss_N(const std::vector<double>& objective_N, int candidate) const {
    const std::uint64_t places = candidates_.subsets.places(candidates_.subset(candidate));
    double worst_N = -infinity;
    for (std::uint64_t rest = places; rest != 0; rest &= rest - 1) {
        const std::uint64_t lost = rest & (~rest + 1);
        const int left = candidates_.subsets.at(places & ~lost);
        worst_N = std::max(worst_N, objective_N[candidates_.of(left, candidates_.method(candidate))]);
    }
    return worst_N;
}

bool PlacementSearch::survives_loss(const std::vector<double>& objective_N, int candidate) const {
    const double limit_N = study_.plan.placement.largest_error_after_loss_N;
    return limit_N == PlacementPlan{}.largest_error_after_loss_N ||
           after_loss_N(objective_N, candidate) <= limit_N;
}

double PlacementSearch::min_after_loss_N(const PlacementScope& scope) const {
    const std::vector<double> objective_N = objectives_N(scope);
    double min_N = infinity;
    for (int c = candidates_.of(1, 0); c < candidates_.count(); ++c) {
        if (allowed_[candidates_.subset(c)]) min_N = std::min(min_N, after_loss_N(objective_N, c));
    }
    return min_N;
}

// The allowed sets of one size, each with the method that suits it best, best first.
std::vector<PlacementSearch::Ranked> PlacementSearch::ranked_sets(const std::vector<double>& objective_N,
                                                                  int sensors) const {
    std::vector<Ranked> ranked;
    for (int s = 1; s < candidates_.subsets.count(); ++s) {
        if (!allowed_[s] || candidates_.subsets.sensors(s) != sensors) continue;
        Ranked best{-1, infinity};
        for (std::size_t m = 0; m < candidates_.methods.size(); ++m) {
            const int candidate = candidates_.of(s, static_cast<int>(m));
            if (objective_N[candidate] < best.objective_N && survives_loss(objective_N, candidate)) {
                best = {candidate, objective_N[candidate]};
            }
        }
        if (best.candidate >= 0) ranked.push_back(best);
    }
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const Ranked& a, const Ranked& b) { return a.objective_N < b.objective_N; });
    return ranked;
}

std::vector<PlacementScope> PlacementSearch::scopes() const {
    std::vector<PlacementScope> scopes;
    std::vector<int> reference;
    for (std::size_t r = 0; r < fractions_.regime.size(); ++r) {
        scopes.emplace_back("regime", std::string(name_of(study_.plan.regimes[r].regime)),
                            fractions_.regime[r]);
        const std::vector<double> objective_N = objectives_N(scopes.back());
        int best = -1;
        for (int sensors = 1; sensors <= candidates_.subsets.max_sensors(); ++sensors) {
            const std::vector<Ranked> ranked = ranked_sets(objective_N, sensors);
            if (ranked.empty()) continue;
            if (best < 0 || ranked.front().objective_N < objective_N[best]) best = ranked.front().candidate;
        }
        reference.push_back(best);
    }
    const bool any_allowed =
        std::all_of(reference.begin(), reference.end(), [](int best) { return best >= 0; });
    if (any_allowed) scopes.emplace_back("minimax_regret", fractions_.regime, reference);
    scopes.emplace_back("duty_cycle", "", fractions_.duty);
    return scopes;
}

// By count: the set that adding the best sensor one at a time reaches; 0 where it reaches none.
std::vector<int> PlacementSearch::greedy_forward(const std::vector<double>& objective_N) const {
    const SensorSubsets& subsets = candidates_.subsets;
    std::vector<int> by_count(subsets.max_sensors() + 1, 0);
    std::vector<int> required = study_.plan.placement.required_nodes;
    std::sort(required.begin(), required.end());
    int here = subsets.find(required);
    if (here > 0) by_count[subsets.sensors(here)] = here;
    while (here >= 0 && subsets.sensors(here) < subsets.max_sensors()) {
        int best = -1;
        for (std::size_t p = 0; p < subsets.usable_nodes().size(); ++p) {
            const std::uint64_t places = subsets.places(here) | std::uint64_t{1} << p;
            if (places == subsets.places(here)) continue;
            const int next = subsets.at(places);
            if (!constraints_.allow_on_the_way(subsets.nodes_of(next))) continue;
            if (best < 0 ||
                objective_N[best_method(objective_N, next)] < objective_N[best_method(objective_N, best)])
                best = next;
        }
        here = best;
        if (here > 0) by_count[subsets.sensors(here)] = here;
    }
    return by_count;
}

// By count: the set that removing the least useful sensor one at a time reaches, starting with all.
std::vector<int> PlacementSearch::greedy_backward(const std::vector<double>& objective_N) const {
    const SensorSubsets& subsets = candidates_.subsets;
    std::vector<int> by_count(subsets.max_sensors() + 1, 0);
    int here = subsets.find(subsets.usable_nodes());  // -1 if the set of all nodes is too large
    while (here > 0) {
        by_count[subsets.sensors(here)] = here;
        int best = -1;
        for (std::uint64_t rest = subsets.places(here); rest != 0; rest &= rest - 1) {
            const int next = subsets.at(subsets.places(here) & ~(rest & (~rest + 1)));
            if (next == 0) continue;
            if (best < 0 ||
                objective_N[best_method(objective_N, next)] < objective_N[best_method(objective_N, best)])
                best = next;
        }
        here = best;
    }
    return by_count;
}

// By count: the allowed set whose readings carry the most information about the state (D-optimal).
std::vector<int> PlacementSearch::max_information(const PlacementScope& scope) const {
    const SensorSubsets& subsets = candidates_.subsets;
    const std::vector<double>& fraction = scope.name() == "regime" ? scope.fraction() : fractions_.duty;
    std::vector<SetInformation> information;
    for (const PreparedScenario& scenario : study_.scenarios) {
        information.emplace_back(scenario, study_.plan.noise_levels[noise_index_].level);
    }
    std::vector<int> by_count(subsets.max_sensors() + 1, 0);
    std::vector<double> max_nats(by_count.size(), -1.0);
    for (int s = 1; s < subsets.count(); ++s) {
        if (!allowed_[s]) continue;
        double nats = 0.0;
        for (std::size_t k = 0; k < fraction.size(); ++k) {
            if (fraction[k] > 0.0) nats += fraction[k] * information[k].nats(subsets.nodes_of(s));
        }
        if (nats > max_nats[subsets.sensors(s)]) {
            max_nats[subsets.sensors(s)] = nats;
            by_count[subsets.sensors(s)] = s;
        }
    }
    return by_count;
}

JudgedLayout PlacementSearch::judged(const std::vector<double>& objective_N, const std::string& how,
                                     int candidate) const {
    JudgedLayout layout;
    layout.candidate = candidate;
    layout.how = how;
    layout.nodes = candidates_.subsets.nodes_of(candidates_.subset(candidate));
    layout.method = candidates_.methods[candidates_.method(candidate)]->name;
    layout.searched_N = objective_N[candidate];
    layout.after_loss_N = after_loss_N(objective_N, candidate);
    layout.cost = constraints_.cost(layout.nodes);
    layout.breaks = constraints_.broken_by(layout.nodes);
    if (!survives_loss(objective_N, candidate)) layout.breaks.emplace_back("largest_error_after_loss_N");
    return layout;
}

// Paired differences of every allowed candidate of the count to the optimum.
void PlacementSearch::compare_all(const PlacementScope& scope, const std::vector<double>& objective_N,
                                  CountAnswer& answer) const {
    const SensorSubsets& subsets = candidates_.subsets;
    const int optimum = answer.optimum.candidate;
    std::vector<int> others;
    for (int s = 1; s < subsets.count(); ++s) {
        if (!allowed_[s] || subsets.sensors(s) != answer.sensors) continue;
        for (std::size_t m = 0; m < candidates_.methods.size(); ++m) {
            const int candidate = candidates_.of(s, static_cast<int>(m));
            if (candidate != optimum && survives_loss(objective_N, candidate)) others.push_back(candidate);
        }
    }
    if (others.empty()) return;
    const SimultaneousIntervals intervals(draws_.blocks().count(), others.size(), alpha_);
    const Score best = scope.score(draws_.scenarios(), optimum);
    for (const int other : others) {
        const IntervalEstimate difference =
            intervals.of(difference_of(scope.score(draws_.scenarios(), other), best));
        answer.at_most_better_N = std::max(answer.at_most_better_N, -difference.low_N);
        if (difference.low_N > 0.0) continue;
        answer.indifferent.push_back({subsets.nodes_of(candidates_.subset(other)),
                                      std::string(candidates_.methods[candidates_.method(other)]->name),
                                      difference});
    }
    std::stable_sort(answer.indifferent.begin(), answer.indifferent.end(), [](const auto& a, const auto& b) {
        return a.difference.value_N < b.difference.value_N;
    });
}

ScopeAnswer PlacementSearch::answer(const PlacementScope& scope, int runners_up) const {
    const SensorSubsets& subsets = candidates_.subsets;
    const std::vector<double> objective_N = objectives_N(scope);
    const std::vector<int> forward = greedy_forward(objective_N);
    const std::vector<int> backward = greedy_backward(objective_N);
    const std::vector<int> informative = max_information(scope);
    ScopeAnswer answer{scope.name(), scope.regime(), {}, 0};
    for (int sensors = 1; sensors <= subsets.max_sensors(); ++sensors) {
        const std::vector<Ranked> ranked = ranked_sets(objective_N, sensors);
        if (ranked.empty()) continue;
        CountAnswer count;
        count.sensors = sensors;
        count.allowed_layouts = static_cast<int>(ranked.size());
        count.optimum = judged(objective_N, "optimum", ranked.front().candidate);
        for (std::size_t k = 1; k < ranked.size() && static_cast<int>(k) <= runners_up; ++k) {
            count.runners_up.push_back(judged(objective_N, "runner_up", ranked[k].candidate));
        }
        for (const LayoutFamily& family : layout_families()) {
            int best = -1;  // of the family's variants
            for (const Layout& layout : family.layouts(sensors, study_.nodes())) {
                const int subset = subsets.find(layout.nodes);
                if (subset <= 0) continue;
                const int candidate = best_method(objective_N, subset);
                if (best < 0 || objective_N[candidate] < objective_N[best]) best = candidate;
            }
            if (best >= 0) count.beside.push_back(judged(objective_N, std::string(family.name), best));
        }
        const auto add = [&](const std::string& how, int subset) {
            if (subset > 0)
                count.beside.push_back(judged(objective_N, how, best_method(objective_N, subset)));
        };
        add("greedy_forward", forward[sensors]);
        add("greedy_backward", backward[sensors]);
        add("d_optimal", informative[sensors]);
        compare_all(scope, objective_N, count);
        answer.counts.push_back(std::move(count));
    }
    return answer;
}

}  // namespace capstan
