#include <fmt/format.h>

#include <limits>
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

// Of one cable with so many sensors.
Data cable_data(const BudgetCable& cable, int sensors) {
    Data data = {{"cable", cable.plan.name}, {"sensors", sensors}};
    const CountAnswer* const count =
        sensors == 0 ? nullptr : best_by_count(cable.found, sensors)[static_cast<std::size_t>(sensors) - 1];
    Data places = Data::list();
    if (count != nullptr) {
        const Cable cut(cable.plan.transmission.cable);
        for (const int node : count->optimum.nodes) places.push_back(cut.node_position_m(node));
    }
    data["nodes"] = count == nullptr ? Data::list() : Data(from_one(count->optimum.nodes));
    data["places_m"] = places;
    data["method"] = count == nullptr ? "" : count->optimum.method;
    data["method_title"] = count == nullptr ? "-" : title_of_method(count->optimum.method);
    data["error_N"] = count == nullptr ? cable.no_sensor_N : count->optimum.independent.value_N;
    if (count != nullptr)
        data["interval_95_N"] =
            Data::list({count->optimum.independent.low_N, count->optimum.independent.high_N});
    return data;
}

}  // namespace

std::vector<double> errors_by_count_N(const BudgetCable& cable, int sensors) {
    std::vector<double> error_N{cable.no_sensor_N};
    for (const CountAnswer* const count : best_by_count(cable.found, sensors))
        error_N.push_back(count == nullptr ? std::numeric_limits<double>::infinity()
                                           : count->optimum.independent.value_N);
    return error_N;
}

reports::Answer budget_answer(const std::vector<BudgetCable>& cables, const std::vector<BudgetShare>& shares,
                              BudgetObjective objective) {
    const BudgetShare& best = shares.back();
    const int used = std::accumulate(best.sensors.begin(), best.sensors.end(), 0);
    std::string words;
    for (std::size_t c = 0; c < cables.size(); ++c)
        words += fmt::format("{}{} on {}", c == 0 ? "" : ", ", best.sensors[c], cables[c].plan.name);
    reports::Answer answer{
        .id = "budget",
        .kind = "One budget of sensors for several cables",
        .title = fmt::format("{} cables", cables.size()),
        .headline = fmt::format(
            "use {}: {}. Expected tension error over the duty cycles: {:.3f} N on average, {:.3f} N "
            "on the worst cable.",
            counted(static_cast<std::size_t>(used), "sensor"), words, best.mean_N, best.largest_N)};
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
    answer.sections = {
        {.id = "cables",
         .heading = "Sensors of each cable",
         .tables = {{"cables",
                     "",
                     {{"cable", "cable"},
                      {"sensors", "sensors"},
                      {"nodes", "nodes"},
                      {"places_m", "places", "m", ".3f"},
                      {"method_title", "method"},
                      {"error_N", "error", "N", ".3f"},
                      {"interval_95_N", "95% interval", "N", ".3f"}},
                     answer.values["cables"]}}},
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
             "Each cable has its best layout of its number of sensors, as `capstan place` finds it, judged on "
             "independent draws over its own duty cycle. The distribution with the smallest {} is exact. Without a "
             "sensor the estimate is the mean of all states that the motion allows.",
             objective_words(objective))}};
    return answer;
}

}  // namespace capstan::answers
