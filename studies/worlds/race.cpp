#include <algorithm>
#include <limits>

#include "capstan/worlds/choice.h"
#include "capstan/worlds/paired_worlds.h"

namespace capstan {

namespace {

int looks(int worlds) {
    int count = 1;
    for (int at = fewest_worlds; at < worlds; at *= 2) ++count;
    return count;
}

int best_of(const Choice& choice, const std::vector<int>& candidates, int worlds) {
    int best = candidates.front();
    double least_N = std::numeric_limits<double>::infinity();
    for (const int candidate : candidates) {
        const double score_N = choice.score(candidate, 0, worlds);
        if (score_N < least_N) {
            least_N = score_N;
            best = candidate;
        }
    }
    return best;
}

// Leaves out what is worse than the best, and what cannot be better by more than the resolution. True where
// more worlds would still tell something.
bool narrow(const Choice& choice, Group& group, int worlds, double level) {
    const int best = best_of(choice, group.left, worlds);
    std::erase_if(group.left, [&](int candidate) {
        if (candidate == best) return false;
        const Estimated worse =
            choice.paired(Condition::as_stated, candidate, Condition::as_stated, best, 0, worlds, level);
        if (worse.low_N <= 0.0 && worse.low_N >= -choice.resolution_N()) group.settled.push_back(candidate);
        return worse.low_N >= -choice.resolution_N();
    });
    return group.left.size() > 1;
}

std::vector<PriceBest> best_of_each_price(Choice& choice, std::vector<Group>& groups) {
    std::vector<int> winners;
    for (Group& group : groups) {
        const int best = best_of(choice, group);
        std::erase(group.left, best);
        group.left.insert(group.left.begin(), best);
        winners.push_back(best);
    }
    winners.push_back(0);
    choice.fill(Condition::as_stated, winners, choice.worlds(), 2 * choice.worlds(), "independent worlds");
    std::vector<PriceBest> prices;
    double least_N = choice.expected(0).objective.value_N;
    for (const Group& group : groups) {
        PriceBest best;
        best.price = group.price;
        best.candidates = group.candidates;
        best.expected = choice.expected(group.left.front());
        best.selected_N = choice.score(group.left.front(), 0, group.worlds);
        best.ties.assign(group.left.begin() + 1, group.left.end());
        best.ties.insert(best.ties.end(), group.settled.begin(), group.settled.end());
        const auto is_alike = [&](int tie) { return choice.table().are_alike(tie, group.left.front()); };
        std::copy_if(best.ties.begin(), best.ties.end(), std::back_inserter(best.alike), is_alike);
        std::erase_if(best.ties, is_alike);
        best.on_front = best.expected.objective.value_N < least_N;
        least_N = std::min(least_N, best.expected.objective.value_N);
        prices.push_back(std::move(best));
    }
    return prices;
}

// Up the front as long as a unit of price lowers the error enough.
std::optional<std::size_t> recommended_of(const Choice& choice, const WorldAnswer& answer,
                                          double worthwhile_N) {
    std::optional<std::size_t> at;
    double price = 0.0;
    double error_N = answer.no_sensor.objective.value_N;
    for (bool moved = true; moved;) {
        moved = false;
        for (std::size_t next = at ? *at + 1 : 0; next < answer.prices.size(); ++next) {
            const PriceBest& best = answer.prices[next];
            if (!best.on_front) continue;
            const double gain_N = error_N - best.expected.objective.value_N;
            if (gain_N < worthwhile_N * (best.price - price)) continue;
            at = next;
            price = best.price;
            error_N = best.expected.objective.value_N;
            moved = true;
            break;
        }
    }
    if (!at) return at;
    const Estimated gain =
        choice.paired(Condition::as_stated, 0, Condition::as_stated, answer.prices[*at].expected.candidate,
                      choice.worlds(), 2 * choice.worlds());
    return gain.low_N > 0.0 ? at : std::nullopt;
}

}  // namespace

std::vector<Group> groups_of(const Choice& choice, std::vector<int> candidates) {
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](int a, int b) { return choice.candidate(a).price < choice.candidate(b).price; });
    std::vector<Group> groups;
    for (const int candidate : candidates) {
        const double price = choice.candidate(candidate).price;
        if (groups.empty() || price > groups.back().price * (1.0 + 1e-9))
            groups.push_back({price, 0, {}, {}, 0});
        groups.back().left.push_back(candidate);
        ++groups.back().candidates;
    }
    return groups;
}

// A quantile of few worlds says nothing, so its race has one look only.
void race(Choice& choice, std::vector<Group>& groups, double level) {
    const bool in_rounds = choice.objective() != PlacementObjective::quantile_95;
    const double of_test = level / (in_rounds ? looks(choice.worlds()) : 1);
    int worlds = in_rounds ? std::min(fewest_worlds, choice.worlds()) : choice.worlds();
    std::vector<Group*> open;
    for (Group& group : groups) open.push_back(&group);
    for (int before = 0;; before = worlds, worlds = std::min(2 * worlds, choice.worlds())) {
        std::vector<int> running;
        for (const Group* group : open) running.insert(running.end(), group->left.begin(), group->left.end());
        choice.fill(Condition::as_stated, running, before, worlds, "comparing sets of sensors");
        for (Group* group : open) group->worlds = worlds;
        std::erase_if(open, [&](Group* group) { return !narrow(choice, *group, worlds, of_test); });
        if (worlds == choice.worlds() || open.empty()) break;
    }
}

int best_of(const Choice& choice, const Group& group) {
    return best_of(choice, group.left, group.worlds);
}

WorldAnswer choose_of_each_price(Choice& choice) {
    if (choice.table().grows()) search_greedily(choice);
    WorldAnswer answer;
    answer.offers = choice.table().offers();
    answer.pieces = straight_pieces(choice.table().plan(), answer.offers);
    answer.candidates = choice.table().candidates();
    answer.worlds = choice.worlds();
    answer.resolution_N = choice.resolution_N();
    std::vector<int> compared;
    for (int k = 1; k < choice.candidates(); ++k)
        if (!choice.candidate(k).is_bound) compared.push_back(k);
    std::vector<Group> groups = groups_of(choice, compared);
    race(choice, groups, alpha / static_cast<double>(choice.candidates()));
    answer.trials = choice.table().entries(Condition::as_stated, choice.worlds());
    answer.prices = best_of_each_price(choice, groups);
    answer.no_sensor = choice.expected(0);
    answer.recommended = recommended_of(choice, answer, choice.table().plan().worthwhile_gain_N);
    answer.gain_over_none =
        choice.paired(Condition::as_stated, 0, Condition::as_stated, answer.best().expected.candidate,
                      choice.worlds(), 2 * choice.worlds());
    return answer;
}

double objective_of(PlacementObjective objective, const WorldError& error) {
    switch (objective) {
        case PlacementObjective::all_nodes:
        case PlacementObjective::quantile_95:
            return error.mean_abs_N;
        case PlacementObjective::load_end:
            return error.load_end_N;
        case PlacementObjective::worst_node:
            return error.worst_place_N;
    }
    return 0.0;
}

}  // namespace capstan
