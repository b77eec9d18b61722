#pragma once

#include <cmath>
#include <vector>

#include "capstan/worlds/paired_worlds.h"
#include "capstan/worlds/world_study.h"

namespace capstan {

/// Of every statement, over all looks and candidates together.
inline constexpr double alpha = 0.05;
/// The first look at all candidates; every later one doubles it.
inline constexpr int fewest_worlds = 20;

/// All that a choice asks of the table.
class Choice {
  public:
    explicit Choice(ErrorTable& table) : table_(table), objective_(table.plan().placement.objective) {}

    int worlds() const { return table_.plan().repetitions; }
    int candidates() const { return static_cast<int>(table_.candidates().size()); }
    double resolution_N() const { return table_.plan().placement.resolution_N; }
    PlacementObjective objective() const { return objective_; }
    const Candidate& candidate(int index) const {
        return table_.candidates()[static_cast<std::size_t>(index)];
    }
    ErrorTable& table() { return table_; }

    std::vector<double> values(Condition condition, int candidate, int first, int last) const {
        std::vector<double> values;
        for (int world = first; world < last; ++world)
            values.push_back(objective_of(objective_, table_.at(condition, candidate, world)));
        return values;
    }
    double load_end_N(Condition condition, int candidate, int first, int last) const {
        double sum_N = 0.0;
        for (int world = first; world < last; ++world)
            sum_N += table_.at(condition, candidate, world).load_end_N;
        return sum_N / (last - first);
    }
    std::vector<double> parts(Condition condition, int candidate, int first, int last) const {
        return contributions(objective_, values(condition, candidate, first, last));
    }
    double score(int candidate, int first, int last) const {
        const auto all = values(Condition::as_stated, candidate, first, last);
        return objective_ == PlacementObjective::quantile_95 ? quantile_of(all, 0.95) : mean_of(all).value_N;
    }
    Estimated paired(Condition condition, int candidate, Condition other_condition, int other, int first,
                     int last, double level = alpha) const {
        return mean_of(
            differences(parts(condition, candidate, first, last), parts(other_condition, other, first, last)),
            level);
    }
    void fill(Condition condition, std::span<const int> candidates, int first, int last,
              std::string_view activity) {
        table_.fill(condition, candidates, first, last, activity);
    }

    /// From worlds that had no part in choosing it.
    Expected expected(int candidate) const {
        const int first = worlds();
        const int last = 2 * worlds();
        const auto all = values(Condition::as_stated, candidate, first, last);
        Expected result;
        result.candidate = candidate;
        result.objective = mean_of(contributions(objective_, all));
        result.error_95_N = quantile_of(all, 0.95);
        double squares = 0.0;
        std::vector<double> covered;
        for (int world = first; world < last; ++world) {
            const WorldError& error = table_.at(Condition::as_stated, candidate, world);
            squares += error.mean_square_N2 / worlds();
            result.load_end_N += error.load_end_N / worlds();
            result.whole_cable_N += error.mean_abs_N / worlds();
            result.worst_place_N += error.worst_place_N / worlds();
            covered.push_back(error.covered_fraction);
        }
        result.covered_fraction = mean_of(covered).value_N;
        result.covered_at_most = mean_of(covered).high_N;
        result.rms_N = std::sqrt(squares);
        return result;
    }

  private:
    ErrorTable& table_;
    PlacementObjective objective_;
};

/// The candidates of one price, and those still in the race.
struct Group {
    double price = 0.0;
    int candidates = 0;
    std::vector<int> left;
    std::vector<int> settled;  ///< not told from the best, but better by less than the resolution at most
    int worlds = 0;            ///< that all of those left have run
};

/// Candidates by price, the cheapest first; of one price in the order given.
std::vector<Group> groups_of(const Choice& choice, std::vector<int> candidates);

/// Runs the groups on common worlds until the best of each is resolved. `level` of all tests together.
void race(Choice& choice, std::vector<Group>& groups, double level);

/// The best of those left.
int best_of(const Choice& choice, const Group& group);

/// Adds sets to the table that grow from what is required by the sensor that lowers the error most; where
/// prices differ, also by the one that lowers it most per price. After each, every sensor may move to a
/// neighbouring place. Ends where nothing more is allowed, or where two further sensors in turn gain less
/// than the resolution.
void search_greedily(Choice& choice);

/// The best candidate of every price, and which price is worth it; without baselines and what is said beside.
WorldAnswer choose_of_each_price(Choice& choice);

}  // namespace capstan
