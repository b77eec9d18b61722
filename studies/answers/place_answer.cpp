#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "capstan/answers/placement_answers.h"
#include "capstan/config/config_writer.h"
#include "capstan/estimation/fusion_method.h"
#include "capstan/placement/prepared_study.h"
#include "capstan/sensing/layout.h"

namespace capstan::answers {

namespace {

using reports::AnswerTable;
using reports::Column;
using reports::Data;
using reports::Table;

constexpr const char* compared[] = {"even",           "distal",          "both",
                                    "greedy_forward", "greedy_backward", "d_optimal"};

std::string title_of_choice(const std::string& how) {
    if (how == "optimum") return "best layout";
    if (how == "greedy_forward") return "greedy forward";
    if (how == "greedy_backward") return "greedy backward";
    if (how == "d_optimal") return "D-optimal";
    const LayoutFamily* family = find_layout_family(how);
    return family == nullptr ? how : std::string(family->title);
}

std::string words_of(PlacementObjective objective) {
    switch (objective) {
        case PlacementObjective::all_nodes:
            return "mean error over all nodes";
        case PlacementObjective::load_end:
            return "mean error at the load end";
        case PlacementObjective::worst_node:
            return "mean error at the worst node";
        case PlacementObjective::quantile_95:
            return "error that 95% of the draws stay below";
    }
    return {};
}

std::string title_of(const ScopeAnswer& scope) {
    if (scope.scope == "minimax_regret") return "Safe in every regime: smallest worst regret [N]";
    if (scope.scope == "duty_cycle") return "Over the duty cycle [N]";
    std::string regime = scope.regime;
    std::replace(regime.begin(), regime.end(), '_', ' ');
    return "Regime " + regime + " [N]";
}

Data interval_of(const IntervalEstimate& estimate) {
    return Data::list({estimate.low_N, estimate.high_N});
}

Data layout_data(const JudgedLayout& layout) {
    return {
        {"how", layout.how},
        {"nodes", from_one(layout.nodes)},
        {"method", layout.method},
        {"method_title", title_of_method(layout.method)},
        {"error_N", layout.independent.value_N},
        {"interval_95_N", interval_of(layout.independent)},
        {"error_on_search_draws_N", layout.searched_N},
        {"difference_to_optimum", estimate_data(layout.difference)},
        {"error_after_worst_loss_N", std::isfinite(layout.after_loss_N) ? Data(layout.after_loss_N) : Data()},
        {"cost", layout.cost},
        {"breaks", layout.breaks}};
}

int indifferent_sets(const CountAnswer& count) {
    std::set<std::vector<int>> sets;
    for (const IndifferentLayout& other : count.indifferent) sets.insert(other.nodes);
    sets.erase(count.optimum.nodes);
    return static_cast<int>(sets.size());
}

Data count_data(const CountAnswer& count) {
    Data data = {{"sensor_count", count.sensors},
                 {"allowed_layouts", count.allowed_layouts},
                 {"optimum", layout_data(count.optimum)},
                 {"optimism_N", count.optimism_N},
                 {"equal_layouts", indifferent_sets(count)},
                 {"none_better_by_more_than_N", count.at_most_better_N},
                 {"d_optimal_gap_nats", count.d_optimal_gap_nats},
                 {"excess_N", Data::record()},
                 {"runners_up", Data::list()},
                 {"beside", Data::list()},
                 {"indifferent", Data::list()}};
    for (const JudgedLayout& layout : count.runners_up) data["runners_up"].push_back(layout_data(layout));
    for (const JudgedLayout& layout : count.beside) {
        data["beside"].push_back(layout_data(layout));
        data["excess_N"][layout.how] = layout.difference.value_N;
    }
    for (const IndifferentLayout& other : count.indifferent) {
        data["indifferent"].push_back({{"nodes", from_one(other.nodes)},
                                       {"method", other.method},
                                       {"difference_N", other.difference.value_N},
                                       {"interval_95_N", interval_of(other.difference)}});
    }
    return data;
}

Data scope_data(const ScopeAnswer& scope) {
    Data data = {{"scope", scope.scope}};
    if (scope.scope == "regime") data["regime"] = scope.regime;
    data["recommended_sensor_count"] = scope.recommended_count;
    data["counts"] = Data::list();
    for (const CountAnswer& count : scope.counts) {
        Data row = count_data(count);
        row["recommended"] = count.sensors == scope.recommended_count;
        data["counts"].push_back(std::move(row));
    }
    return data;
}

AnswerTable scope_table(const ScopeAnswer& scope, const Data& data, SearchKind search) {
    AnswerTable table{"counts_" + (scope.scope == "regime" ? scope.regime : scope.scope),
                      title_of(scope),
                      {{"sensor_count", "sensors"},
                       {"recommended", "recommended"},
                       {"optimum.nodes", "best nodes"},
                       {"optimum.method_title", "method"},
                       {"optimum.error_N", "error", "N", ".3f"},
                       {"optimum.interval_95_N", "95% interval", "N", ".3f"},
                       {"optimism_N", "optimism", "N", "+.4f"},
                       {"optimum.error_after_worst_loss_N", "1 lost", "N", ".3f"}},
                      *data.find("counts")};
    table.columns.push_back(search == SearchKind::exhaustive
                                ? Column{"equal_layouts", "not worse"}
                                : Column{"none_better_by_more_than_N", "gap", "N", ".3f"});
    for (const char* how : compared)
        table.columns.push_back({std::string("excess_N.") + how, title_of_choice(how), "", "+.3f"});
    return table;
}

// What branch and bound proves of the D-optimal layouts of a long cable.
std::string d_optimal_words(const PlacementAnswer& found) {
    double gap_nats = 0.0;
    for (const CountAnswer& count : found.scopes.front().counts)
        gap_nats = std::max(gap_nats, count.d_optimal_gap_nats);
    return gap_nats <= 0.0
               ? "D-optimal layouts are proven to carry the most information of their count."
               : fmt::format(
                     "No layout of that count carries more information than the D-optimal one by more "
                     "than {:.3f} nats.",
                     gap_nats);
}

std::string note_of(const StudyPlan& plan, const PlacementAnswer& found) {
    const std::string reliability =
        found.search == SearchKind::exhaustive
            ? "Not worse: how many other layouts of the count are not significantly worse than the best (paired t test "
              "on the search's draws at the 5% level, Bonferroni-corrected over all allowed choices of layout and "
              "fusion method of the count)."
            : "Gap: no layout of that count is better by more than this, if a further sensor never increases the "
              "error. " +
                  d_optimal_words(found);
    return fmt::format(
        "Recommended: the count above which one more sensor gains less than {:g} N. Error: estimated on {} "
        "independent draws; optimism: by how much the draws of the search made it look better. {} 1 lost: error "
        "without the sensor whose loss costs most. The last columns: how much larger the error of each choice is "
        "than that of the best layout of the count, each with the method that suits it best.",
        plan.worthwhile_gain_N, found.repetitions, reliability);
}

// The error without any sensor over the duty cycle, of the objective that it is known for.
std::optional<double> no_sensor_N(const StudyPlan& plan) {
    if (plan.placement.objective != PlacementObjective::all_nodes || !plan.placement.required_nodes.empty())
        return std::nullopt;
    return no_sensor_errors_N(plan).at("duty_cycle");
}

std::string headline_of(const PlacementAnswer& found, std::optional<double> none_N) {
    const ScopeAnswer& scope = found.scopes.back();  // the duty cycle
    for (const CountAnswer& count : scope.counts) {
        if (count.sensors != scope.recommended_count) continue;
        if (none_N && count.optimum.independent.high_N >= *none_N)
            return fmt::format(
                "use no sensor. Expected tension error over the duty cycle without any: {:.3f} N; with {} at {} {}: {:.3f} N.",
                *none_N, counted(static_cast<std::size_t>(count.sensors), "sensor"),
                count.sensors == 1 ? "node" : "nodes", nodes_as_people_count(count.optimum.nodes),
                count.optimum.independent.value_N);
        return fmt::format(
            "use {} at {} {}, fused by {}. Expected tension error over the duty cycle: {:.3f} N "
            "(95% interval {:.3f} to {:.3f} N{}).",
            counted(static_cast<std::size_t>(count.sensors), "sensor"), count.sensors == 1 ? "node" : "nodes",
            nodes_as_people_count(count.optimum.nodes), title_of_method(count.optimum.method),
            count.optimum.independent.value_N, count.optimum.independent.low_N,
            count.optimum.independent.high_N,
            none_N ? fmt::format("; without any sensor {:.3f} N", *none_N) : std::string());
    }
    return "no count of sensors satisfies the constraints.";
}

Table error_table(const PlacementAnswer& found) {
    Table table{"place_error",
                "Error of the best layout and of the families, on independent draws",
                {"question", "choice", "sensor_count", "nodes", "method_title", "error_N", "interval_low_N",
                 "interval_high_N"},
                {}};
    const auto add = [&](const ScopeAnswer& scope, const CountAnswer& count, const JudgedLayout& layout) {
        table.rows.push_back({title_of(scope), title_of_choice(layout.how), std::int64_t{count.sensors},
                              nodes_as_people_count(layout.nodes), title_of_method(layout.method),
                              layout.independent.value_N, layout.independent.low_N,
                              layout.independent.high_N});
    };
    for (const ScopeAnswer& scope : found.scopes) {
        for (const CountAnswer& count : scope.counts) {
            add(scope, count, count.optimum);
            for (const JudgedLayout& layout : count.beside) {
                if (find_layout_family(layout.how) != nullptr) add(scope, count, layout);
            }
        }
    }
    return table;
}

// One row for each sensor of the best layouts.
Table node_table(const PlacementAnswer& found) {
    Table table{"place_node",
                "Nodes of the best layout of each number of sensors",
                {"question", "sensor_count", "node", "error_N"},
                {}};
    for (const ScopeAnswer& scope : found.scopes) {
        for (const CountAnswer& count : scope.counts) {
            for (const int node : count.optimum.nodes) {
                table.rows.push_back({title_of(scope), std::int64_t{count.sensors}, std::int64_t{node + 1},
                                      count.optimum.independent.value_N});
            }
        }
    }
    return table;
}

}  // namespace

reports::Answer place_answer(const StudyPlan& plan, const PlacementAnswer& found) {
    const bool exhaustive = found.search == SearchKind::exhaustive;
    const std::optional<double> none_N = no_sensor_N(plan);
    reports::Answer answer{
        .id = "place",
        .kind = exhaustive ? "Exhaustive search of all layouts" : "Greedy search on a long cable",
        .title = plan.name,
        .headline = headline_of(found, none_N)};
    answer.values = {{"name", plan.name},
                     {"seed", plan.seed},
                     {"search", exhaustive ? "exhaustive" : "greedy"},
                     {"objective", name_of(plan.placement.objective)},
                     {"noise", found.noise},
                     {"layouts", found.layouts},
                     {"candidates", found.candidates},
                     {"repetitions", found.repetitions},
                     {"no_sensor_error_N", none_N ? Data(*none_N) : Data()},
                     {"scopes", Data::list()}};
    reports::AnswerSection numbers{
        .id = "numbers",
        .heading = "Best layout of each number of sensors",
        .prose =
            fmt::format("{} candidates (layouts times fusion methods) on the same {} draws of sensor noise "
                        "{}; judged by the {}.",
                        found.candidates, found.repetitions, found.noise, words_of(plan.placement.objective)),
        .note = note_of(plan, found)};
    for (const ScopeAnswer& scope : found.scopes) {
        Data data = scope_data(scope);
        numbers.tables.push_back(scope_table(scope, data, found.search));
        answer.values["scopes"].push_back(std::move(data));
    }
    answer.sections = {{.id = "error", .heading = "Error against the number of sensors"},
                       {.id = "nodes", .heading = "Where the sensors go"},
                       std::move(numbers)};
    answer.drawn = {error_table(found), node_table(found)};
    answer.config_text = config::config_text(plan, config::Comments::none);
    return answer;
}

std::vector<int> from_one(std::vector<int> nodes) {
    for (int& node : nodes) ++node;
    return nodes;
}

std::string title_of_method(const std::string& name) {
    const FusionMethod* method = find_fusion_method(name);
    return method == nullptr ? name : std::string(method->title);
}

reports::Data estimate_data(const IntervalEstimate& estimate) {
    return {{"value_N", estimate.value_N}, {"interval_95_N", interval_of(estimate)}};
}

}  // namespace capstan::answers
