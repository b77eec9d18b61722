#include "capstan/worlds/world_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "capstan/estimation/direction_pattern.h"
#include "capstan/worlds/paired_worlds.h"

namespace capstan {

namespace {

constexpr double alpha = 0.05;
// The first look at all candidates; every later one doubles it.
constexpr int worlds_at_first = 20;
// What is said beside the recommendation needs no more worlds than this.
constexpr int worlds_for_knowledge = 100;
constexpr int worlds_for_robustness = 60;
// The paper's estimators are slow, and their errors several times larger.
constexpr int worlds_for_paper = 10;
// Sets of the recommended price that compete where the widths are wrong.
constexpr std::size_t rivals = 3;

// All that is asked of the table, for one plan.
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

    // From worlds that had no part in choosing it.
    Expected expected(int candidate) const {
        const int first = worlds();
        const int last = 2 * worlds();
        const auto all = values(Condition::as_stated, candidate, first, last);
        Expected result;
        result.candidate = candidate;
        result.objective = mean_of(contributions(objective_, all));
        result.error_95_N = quantile_of(all, 0.95);
        double squares = 0.0;
        for (int world = first; world < last; ++world) {
            const WorldError& error = table_.at(Condition::as_stated, candidate, world);
            squares += error.mean_square_N2 / worlds();
            result.load_end_N += error.load_end_N / worlds();
            result.whole_cable_N += error.mean_abs_N / worlds();
            result.worst_place_N += error.worst_place_N / worlds();
            result.covered_fraction += error.covered_fraction / worlds();
        }
        result.rms_N = std::sqrt(squares);
        return result;
    }

  private:
    ErrorTable& table_;
    PlacementObjective objective_;
};

// The candidates of one price, and those still in the race.
struct Group {
    double price = 0.0;
    int candidates = 0;
    std::vector<int> left;
    std::vector<int> settled;  ///< not told from the best, but better by less than the resolution at most
    int worlds = 0;            ///< that all of those left have run
};

std::vector<Group> groups_of(const std::vector<Candidate>& candidates) {
    std::vector<Group> groups;
    for (std::size_t k = 1; k < candidates.size(); ++k) {
        const double price = candidates[k].price;
        if (groups.empty() || price > groups.back().price * (1.0 + 1e-9))
            groups.push_back({price, 0, {}, {}, 0});
        groups.back().left.push_back(static_cast<int>(k));
        ++groups.back().candidates;
    }
    return groups;
}

int looks(int worlds) {
    int count = 1;
    for (int at = worlds_at_first; at < worlds; at *= 2) ++count;
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

// A quantile of few worlds says nothing, so its race has one look only.
std::vector<Group> race(Choice& choice, std::size_t& trials) {
    std::vector<Group> groups = groups_of(choice.table().candidates());
    const bool in_rounds = choice.objective() != PlacementObjective::quantile_95;
    const double level =
        alpha / (static_cast<double>(choice.candidates()) * (in_rounds ? looks(choice.worlds()) : 1));
    int worlds = in_rounds ? std::min(worlds_at_first, choice.worlds()) : choice.worlds();
    std::vector<Group*> open;
    for (Group& group : groups) open.push_back(&group);
    for (int before = 0;; before = worlds, worlds = std::min(2 * worlds, choice.worlds())) {
        std::vector<int> running;
        for (const Group* group : open) running.insert(running.end(), group->left.begin(), group->left.end());
        choice.fill(Condition::as_stated, running, before, worlds, "comparing sets of sensors");
        for (Group* group : open) group->worlds = worlds;
        trials += running.size() * static_cast<std::size_t>(worlds - before);
        std::erase_if(open, [&](Group* group) { return !narrow(choice, *group, worlds, level); });
        if (worlds == choice.worlds() || open.empty()) break;
    }
    return groups;
}

std::vector<PriceBest> best_of_each_price(Choice& choice, std::vector<Group>& groups) {
    std::vector<int> winners;
    for (Group& group : groups) {
        const int best = best_of(choice, group.left, group.worlds);
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

std::optional<int> set_of(const Choice& choice, const std::vector<SensorOffer>& offers,
                          std::vector<SensorKind> kinds, int candidates) {
    std::sort(kinds.begin(), kinds.end());
    for (int k = 1; k < candidates; ++k) {
        std::vector<SensorKind> own;
        for (const int sensor : choice.candidate(k).sensors)
            own.push_back(offers[static_cast<std::size_t>(sensor)].kind);
        std::sort(own.begin(), own.end());
        if (own == kinds) return k;
    }
    return std::nullopt;
}

void add_baselines(Choice& choice, WorldAnswer& answer) {
    using enum SensorKind;
    const auto& offers = choice.table().offers();
    for (const std::vector<SensorKind>& kinds :
         {std::vector{motor_torque}, std::vector{motor_torque, load_displacement}}) {
        const std::optional<int> set = set_of(choice, offers, kinds, choice.candidates());
        const bool is_listed =
            set && std::any_of(answer.prices.begin(), answer.prices.end(),
                               [&](const PriceBest& best) { return best.expected.candidate == *set; });
        if (!set || is_listed) continue;
        choice.fill(Condition::as_stated, std::vector{*set}, choice.worlds(), 2 * choice.worlds(),
                    "baselines");
        answer.baselines.push_back(choice.expected(*set));
    }
}

// The best set with one sensor more, as far as the race has compared them.
void add_further(Choice& choice, WorldAnswer& answer) {
    const int count = choice.candidate(answer.best().expected.candidate).count() + 1;
    for (const PriceBest& best : answer.prices) {
        if (choice.candidate(best.expected.candidate).count() != count) continue;
        if (answer.further &&
            choice.expected(*answer.further).objective.value_N <= best.expected.objective.value_N)
            continue;
        answer.further = best.expected.candidate;
    }
    if (answer.further)
        answer.further_gain =
            choice.paired(Condition::as_stated, answer.best().expected.candidate, Condition::as_stated,
                          *answer.further, choice.worlds(), 2 * choice.worlds());
}

bool sensors_drift(const Choice& choice, const std::vector<SensorOffer>& offers, int candidate) {
    const auto& sensors = choice.candidate(candidate).sensors;
    return std::any_of(sensors.begin(), sensors.end(), [&](int sensor) {
        const SensorErrors& errors = offers[static_cast<std::size_t>(sensor)].errors;
        return errors.zero > 0.0 || errors.gain_ratio > 0.0;
    });
}

void add_knowledge(Choice& choice, WorldAnswer& answer) {
    const int candidate = answer.best().expected.candidate;
    const Uncertainty& unknown = choice.table().plan().uncertainty;
    const int first = choice.worlds();
    const int last = first + std::min(choice.worlds(), worlds_for_knowledge);
    const std::pair<Condition, bool> asked[] = {
        {Condition::friction_known, unknown.friction_fraction > 0.0},
        {Condition::wrap_known, unknown.wrap_fraction > 0.0},
        {Condition::stiffness_known, unknown.stiffness_fraction > 0.0},
        {Condition::pretension_known, unknown.pretension_fraction > 0.0},
        {Condition::sensors_known, sensors_drift(choice, choice.table().offers(), candidate)}};
    for (const auto& [condition, is_unknown] : asked) {
        if (!is_unknown) continue;
        choice.fill(condition, std::vector{candidate}, first, last, "what calibrating would gain");
        answer.knowledge.push_back(
            {condition, choice.paired(Condition::as_stated, candidate, condition, candidate, first, last)});
    }
}

void add_robustness(Choice& choice, WorldAnswer& answer) {
    const PriceBest& best = answer.best();
    std::vector<int> compared = {best.expected.candidate};
    for (const int tie : best.ties)
        if (compared.size() < rivals) compared.push_back(tie);
    // Named sets of that price lost with the stated widths; with others they may not.
    for (int k = 1; k < choice.candidates() && compared.size() < rivals; ++k) {
        const Candidate& candidate = choice.candidate(k);
        if (std::abs(candidate.price - best.price) > 1e-9 * best.price || candidate.names.empty()) continue;
        if (std::find(compared.begin(), compared.end(), k) == compared.end()) compared.push_back(k);
    }
    const int first = choice.worlds();
    const int last = first + std::min(choice.worlds(), worlds_for_robustness);
    for (const Condition condition :
         {Condition::half_width, Condition::double_width, Condition::wider_worlds}) {
        choice.fill(condition, compared, first, last, "other widths");
        Robustness result;
        result.condition = condition;
        result.error = mean_of(choice.parts(condition, compared.front(), first, last));
        result.best = compared.front();
        const double level = alpha / static_cast<double>(compared.size());
        for (std::size_t k = 1; k < compared.size(); ++k) {
            const Estimated loss =
                choice.paired(condition, compared.front(), condition, compared[k], first, last, level);
            if (loss.value_N <= result.loss.value_N) continue;
            result.best = compared[k];
            result.loss = loss;
        }
        result.flips = result.loss.low_N > 0.0 && result.loss.value_N > choice.resolution_N();
        for (int world = first; world < last; ++world)
            result.covered_fraction +=
                choice.table().at(condition, compared.front(), world).covered_fraction / (last - first);
        answer.robustness.push_back(result);
    }
}

// Richardson: coarse - exact = (coarse - finer) / (1 - 2^-order).
void add_grid(Choice& choice, WorldAnswer& answer) {
    const int candidate = answer.best().expected.candidate;
    const int first = choice.worlds();
    const int last = first + std::max(std::min(choice.worlds(), worlds_at_first), choice.worlds() / 10);
    GridError& grid = answer.grid;
    grid.segments = choice.table().plan().transmission.cable.segments;
    double* const errors[] = {&grid.coarse_N, &grid.finer_N, &grid.finest_N};
    const Condition conditions_of_grid[] = {Condition::as_stated, Condition::finer_grid,
                                            Condition::finest_grid};
    for (int k = 0; k < 3; ++k) {
        choice.fill(conditions_of_grid[k], std::vector{candidate}, first, last, "finer grids");
        *errors[k] = mean_of(choice.values(conditions_of_grid[k], candidate, first, last)).value_N;
    }
    const double ratio = (grid.coarse_N - grid.finer_N) / (grid.finer_N - grid.finest_N);
    grid.order = ratio > 0.0 ? std::clamp(std::log2(ratio), 0.5, 2.0) : 1.0;
    grid.error_N = (grid.coarse_N - grid.finer_N) / (1.0 - std::exp2(-grid.order));
}

void add_paper(Choice& choice, WorldAnswer& answer) {
    const int candidate = answer.best().expected.candidate;
    const auto& offers = choice.table().offers();
    const auto& sensors = choice.candidate(candidate).sensors;
    const bool has_tension = std::any_of(sensors.begin(), sensors.end(), [&](int sensor) {
        return measures_tension(offers[static_cast<std::size_t>(sensor)].kind);
    });
    if (!has_tension || choice.table().plan().transmission.cable.segments > max_estimated_segments) return;
    const int first = choice.worlds();
    const int last = first + std::min(choice.worlds(), worlds_for_paper);
    for (const Condition condition : {Condition::paper_mean, Condition::paper_mean_r, Condition::paper_w_mean,
                                      Condition::paper_w_mean_r}) {
        choice.fill(condition, std::vector{candidate}, first, last, "the paper's estimators");
        answer.paper.push_back({condition, mean_of(choice.parts(condition, candidate, first, last))});
    }
}

}  // namespace

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

WorldAnswer choose_sensors(ErrorTable& table) {
    Choice choice(table);
    WorldAnswer answer;
    answer.offers = table.offers();
    answer.candidates = table.candidates();
    answer.worlds = choice.worlds();
    answer.resolution_N = choice.resolution_N();
    std::vector<Group> groups = race(choice, answer.trials);
    answer.prices = best_of_each_price(choice, groups);
    answer.no_sensor = choice.expected(0);
    add_baselines(choice, answer);
    answer.recommended = recommended_of(choice, answer, table.plan().worthwhile_gain_N);
    answer.gain_over_none =
        choice.paired(Condition::as_stated, 0, Condition::as_stated, answer.best().expected.candidate,
                      choice.worlds(), 2 * choice.worlds());
    add_further(choice, answer);
    add_knowledge(choice, answer);
    add_robustness(choice, answer);
    add_grid(choice, answer);
    add_paper(choice, answer);
    const double target_N = table.plan().placement.target_error_N;
    for (std::size_t k = 0; k < answer.prices.size() && target_N > 0.0 && !answer.cheapest_below_target; ++k)
        if (answer.prices[k].expected.objective.value_N < target_N) answer.cheapest_below_target = k;
    return answer;
}

}  // namespace capstan
