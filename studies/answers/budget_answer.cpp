#include <fmt/format.h>

#include <numeric>

#include "capstan/answers/placement_answers.h"
#include "capstan/sensing/layout.h"

namespace capstan::answers {

namespace {

using reports::Data;

std::string objective_words(BudgetObjective objective) {
    switch (objective) {
        case BudgetObjective::mean:
            return "mean error of the cables";
        case BudgetObjective::largest:
            return "largest error of the cables";
    }
    return {};
}

constexpr const char* no_method = "-";
constexpr const char* ensemble_filter = "ensemble_filter";

// Of one cable with so many sensors.
Data cable_data(const BudgetCable& cable, int sensors) {
    const BudgetChoice& choice = cable.choices[static_cast<std::size_t>(sensors)];
    Data data = {{"cable", cable.name}, {"sensors", sensors}};
    if (choice.method == ensemble_filter || !choice.set.empty()) {
        data["set"] = choice.set;
    } else {
        Data places = Data::list();
        for (const int node : choice.nodes) places.push_back(cable.cut.node_position_m(node));
        data["nodes"] = Data(from_one(choice.nodes));
        data["places_m"] = places;
    }
    data["method"] = choice.method;
    data["method_title"] = choice.method.empty()              ? no_method
                           : choice.method == ensemble_filter ? "Ensemble filter"
                                                              : title_of_method(choice.method);
    data["error_N"] = choice.error.value_N;
    if (choice.error.low_N < choice.error.high_N)
        data["interval_95_N"] = Data::list({choice.error.low_N, choice.error.high_N});
    return data;
}

bool is_over_worlds(const BudgetCable& cable) {
    return !cable.choices.front().set.empty();
}

bool requires_a_sensor(const StudyPlan& plan) {
    return !plan.placement.required_nodes.empty() || !plan.placement.required_m.empty();
}

}  // namespace

BudgetCable budget_cable(const StudyPlan& plan, const PlacementAnswer& found, double no_sensor_N,
                         int sensors) {
    BudgetCable cable{plan.name, Cable(plan.transmission.cable), {{}}};
    if (!requires_a_sensor(plan)) cable.choices.front().error.value_N = no_sensor_N;
    for (const CountAnswer* const count : best_by_count(found, sensors)) {
        BudgetChoice& choice = cable.choices.emplace_back();
        if (count == nullptr) continue;
        const auto& error = count->optimum.independent;
        choice = {
            {error.value_N, error.low_N, error.high_N}, count->optimum.nodes, "", count->optimum.method};
    }
    return cable;
}

BudgetCable budget_cable(const StudyPlan& plan, const WorldAnswer& found, int sensors) {
    BudgetCable cable{plan.name, Cable(plan.transmission.cable),
                      std::vector<BudgetChoice>(static_cast<std::size_t>(sensors) + 1)};
    cable.choices.front().set = "no sensor";
    if (!requires_a_sensor(plan)) cable.choices.front().error = found.no_sensor.objective;
    for (const PriceBest& best : found.prices) {
        const int count = found.set(best.expected.candidate).count();
        if (count < 1 || count > sensors) continue;
        BudgetChoice& choice = cable.choices[static_cast<std::size_t>(count)];
        if (best.expected.objective.value_N < choice.error.value_N)
            choice = {best.expected.objective, {}, found.words(best.expected.candidate), ensemble_filter};
    }
    return cable;
}

reports::Answer budget_answer(const std::vector<BudgetCable>& cables, const std::vector<BudgetShare>& shares,
                              BudgetObjective objective) {
    const BudgetShare& best = shares.back();
    const int used = std::accumulate(best.sensors.begin(), best.sensors.end(), 0);
    std::string words;
    for (std::size_t c = 0; c < cables.size(); ++c)
        words += fmt::format("{}{} on {}", c == 0 ? "" : ", ", best.sensors[c], cables[c].name);
    reports::Answer answer{
        .id = "budget",
        .kind = "One budget of sensors for several cables",
        .title = fmt::format("{} cables", cables.size()),
        .headline = fmt::format("use {}: {}. Expected tension error{}: {:.3f} N on average, {:.3f} N "
                                "on the worst cable.",
                                counted(static_cast<std::size_t>(used), "sensor"), words,
                                is_over_worlds(cables.front()) ? "" : " over the duty cycles", best.mean_N,
                                best.largest_N)};
    answer.values = {{"objective", objective == BudgetObjective::mean ? "mean" : "largest"},
                     {"sensors", used},
                     {"mean_error_N", best.mean_N},
                     {"largest_error_N", best.largest_N},
                     {"cables", Data::list()},
                     {"budgets", Data::list()}};
    for (std::size_t c = 0; c < cables.size(); ++c)
        answer.values["cables"].push_back(cable_data(cables[c], best.sensors[c]));
    int before = -1;
    for (const BudgetShare& share : shares) {
        const int sensors = std::accumulate(share.sensors.begin(), share.sensors.end(), 0);
        if (sensors == before) continue;  // one more did not help
        before = sensors;
        answer.values["budgets"].push_back({{"sensors", sensors},
                                            {"share", share.sensors},
                                            {"mean_error_N", share.mean_N},
                                            {"largest_error_N", share.largest_N}});
    }
    const bool over_worlds = is_over_worlds(cables.front());
    std::vector<reports::Column> columns = {{"cable", "cable"},
                                            {"sensors", "sensors"},
                                            {"method_title", "method"},
                                            {"error_N", "error", "N", ".3f"},
                                            {"interval_95_N", "95% interval", "N", ".3f"}};
    std::vector<reports::Column> where = {{"nodes", "nodes"}, {"places_m", "places", "m", ".3f"}};
    if (over_worlds) where = {{"set", "set"}};
    columns.insert(columns.begin() + 2, where.begin(), where.end());
    answer.sections = {
        {.id = "cables",
         .heading = "Sensors of each cable",
         .tables = {{"cables", "", std::move(columns), answer.values["cables"]}}},
        {.id = "budgets",
         .heading = "Other budgets",
         .tables = {{"budgets",
                     "",
                     {{"sensors", "sensors"},
                      {"share", "share of each cable"},
                      {"mean_error_N", "mean error", "N", ".3f"},
                      {"largest_error_N", "worst cable", "N", ".3f"}},
                     answer.values["budgets"]}},
         .note = fmt::format(
             "Each cable has the best {} of its number of sensors, as `capstan place` finds it, judged on {}. The "
             "distribution with the smallest {} is exact. Without a sensor {}.",
             over_worlds ? "set" : "layout",
             over_worlds ? "worlds that had no part in choosing it"
                         : "independent draws over its own duty cycle",
             objective_words(objective),
             over_worlds ? "the estimator knows the motor's position and the stated uncertainties"
                         : "the estimate is the mean of all states that the motion allows")}};
    return answer;
}

}  // namespace capstan::answers
