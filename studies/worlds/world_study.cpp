#include "capstan/worlds/world_study.h"

#include <algorithm>
#include <cmath>

#include "capstan/estimation/direction_pattern.h"
#include "capstan/worlds/choice.h"
#include "capstan/worlds/paired_worlds.h"

namespace capstan {

namespace {

// What is said beside the recommendation needs no more worlds than this.
constexpr int worlds_for_knowledge = 100;
constexpr int worlds_for_robustness = 60;
// The paper's estimators are slow, and their errors several times larger.
constexpr int worlds_for_paper = 10;
// Sets of the recommended price that compete where the widths are wrong.
constexpr std::size_t rivals = 3;

std::optional<int> set_of(const Choice& choice, const std::vector<SensorOffer>& offers,
                          std::vector<SensorKind> kinds, int candidates) {
    std::sort(kinds.begin(), kinds.end());
    for (int k = 1; k < candidates; ++k) {
        if (choice.candidate(k).is_bound) continue;
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

// Root mean square errors have no mean over worlds of their own; to first order each world adds this.
std::vector<double> rms_parts(Choice& choice, int candidate, int first, int last) {
    std::vector<double> parts;
    double mean_N2 = 0.0;
    for (int world = first; world < last; ++world) {
        parts.push_back(choice.table().at(Condition::as_stated, candidate, world).mean_square_N2);
        mean_N2 += parts.back() / (last - first);
    }
    const double rms_N = std::sqrt(mean_N2);
    for (double& part : parts) part = rms_N + (part - mean_N2) / (2.0 * std::max(rms_N, 1e-12));
    return parts;
}

void add_bound(Choice& choice, WorldAnswer& answer) {
    if (!choice.table().grows()) return;
    const int all = choice.table().bound().value();
    const int first = choice.worlds();
    const int last = 2 * first;
    choice.fill(Condition::as_stated, std::vector{all}, first, last, "all sensors together");
    SearchBound& bound = answer.bound.emplace();
    bound.all = choice.expected(all);
    bound.is_of_rms = choice.objective() == PlacementObjective::worst_node ||
                      choice.objective() == PlacementObjective::quantile_95;
    const auto gap_of = [&](int candidate) {
        Estimated gap = bound.is_of_rms ? mean_of(differences(rms_parts(choice, candidate, first, last),
                                                              rms_parts(choice, all, first, last)))
                                        : choice.paired(Condition::as_stated, candidate, Condition::as_stated,
                                                        all, first, last);
        for (double* end : {&gap.value_N, &gap.low_N, &gap.high_N}) *end = std::max(*end, 0.0);
        return gap;
    };
    bound.gap = gap_of(answer.recommended ? answer.best().expected.candidate : 0);
    for (const PriceBest& best : answer.prices) bound.of_prices.push_back(gap_of(best.expected.candidate));
}

// All sets whose errors are stated.
std::vector<Expected*> stated_errors(WorldAnswer& answer) {
    std::vector<Expected*> stated = {&answer.no_sensor};
    for (Expected& baseline : answer.baselines) stated.push_back(&baseline);
    for (PriceBest& best : answer.prices) stated.push_back(&best.expected);
    if (answer.bound) stated.push_back(&answer.bound->all);
    return stated;
}

// Of all sets together, each in units of its own error, so that chance in one does not decide.
double measured_order(const Choice& choice, const std::vector<int>& sets, int first, int last) {
    double first_fall = 0.0;
    double second_fall = 0.0;
    for (const int set : sets) {
        const auto error_N = [&](Condition condition) {
            return mean_of(choice.values(condition, set, first, last)).value_N;
        };
        const double coarse_N = error_N(Condition::as_stated);
        const double finer_N = error_N(Condition::finer_grid);
        first_fall += (coarse_N - finer_N) / coarse_N;
        second_fall += (finer_N - error_N(Condition::finest_grid)) / coarse_N;
    }
    const double ratio = first_fall / second_fall;
    return ratio > 0.0 ? std::clamp(std::log2(ratio), 0.5, 2.0) : 1.0;
}

// Richardson: coarse - exact = (coarse - finest) / (1 - 4^-order).
void add_grid(Choice& choice, WorldAnswer& answer) {
    using enum Condition;
    const int candidate = (answer.recommended ? answer.best().expected : answer.no_sensor).candidate;
    const int first = choice.worlds();
    const int last = first + std::max(std::min(choice.worlds(), fewest_worlds), choice.worlds() / 10);
    const std::vector<Expected*> stated = stated_errors(answer);
    std::vector<int> sets;
    for (const Expected* expected : stated) sets.push_back(expected->candidate);
    std::sort(sets.begin(), sets.end());
    sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
    for (const Condition condition : {as_stated, finer_grid, finest_grid})
        choice.fill(condition, sets, first, last, "finer grids");

    GridError& grid = answer.grid;
    grid.segments = choice.table().plan().transmission.cable.segments;
    grid.worlds = last - first;
    const auto error_N = [&](Condition condition) {
        return mean_of(choice.values(condition, candidate, first, last)).value_N;
    };
    grid.coarse_N = error_N(as_stated);
    grid.finer_N = error_N(finer_grid);
    grid.finest_N = error_N(finest_grid);
    grid.order = measured_order(choice, sets, first, last);
    const double extrapolation = 1.0 / (1.0 - std::exp2(-2.0 * grid.order));
    const bool is_of_quantile = choice.objective() == PlacementObjective::quantile_95;
    for (Expected* expected : stated) {
        const auto coarse_N = choice.values(as_stated, expected->candidate, first, last);
        const auto finest_N = choice.values(finest_grid, expected->candidate, first, last);
        const double of_mean_N = mean_of(differences(coarse_N, finest_N)).value_N;
        const double of_quantile_N = fall_near(expected->error_95_N, coarse_N, finest_N);
        expected->discretisation_N = extrapolation * (is_of_quantile ? of_quantile_N : of_mean_N);
        expected->error_95_discretisation_N = extrapolation * of_quantile_N;
        expected->load_end_discretisation_N =
            extrapolation * (choice.load_end_N(as_stated, expected->candidate, first, last) -
                             choice.load_end_N(finest_grid, expected->candidate, first, last));
    }
}

void add_paper(Choice& choice, WorldAnswer& answer) {
    const int candidate = answer.best().expected.candidate;
    const auto& offers = choice.table().offers();
    const auto& sensors = choice.candidate(candidate).sensors;
    const bool has_tension = std::any_of(sensors.begin(), sensors.end(), [&](int sensor) {
        return measures_tension(offers[static_cast<std::size_t>(sensor)].kind);
    });
    if (choice.table().plan().transmission.arrangement == CableArrangement::pull_pull) return;
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

WorldAnswer choose_sensors(ErrorTable& table) {
    Choice choice(table);
    WorldAnswer answer = choose_of_each_price(choice);
    add_baselines(choice, answer);
    add_further(choice, answer);
    add_bound(choice, answer);
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
