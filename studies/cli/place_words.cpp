#include "capstan/cli/place_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "capstan/estimation/fusion_method.h"
#include "capstan/platform/wrapped_text.h"

namespace capstan::cli {

namespace {

using nlohmann::ordered_json;

constexpr std::size_t words_width = 100;

// How layouts that stand beside an optimum are headed, in this order.
struct Column {
    std::string_view how;
    std::string_view head;
};
constexpr Column columns[] = {{"even", "Even"},
                              {"distal", "Distal"},
                              {"both", "Both"},
                              {"greedy_forward", "forward"},
                              {"greedy_backward", "backward"},
                              {"d_optimal", "D-opt"}};

const JudgedLayout* find(const CountAnswer& count, std::string_view how) {
    for (const JudgedLayout& layout : count.beside) {
        if (layout.how == how) return &layout;
    }
    return nullptr;
}

std::string nodes_text(const std::vector<int>& nodes) {
    std::string text;
    for (const int node : nodes) text += (text.empty() ? "" : " ") + std::to_string(node + 1);
    return text;
}

std::string newtons(double value_N) {
    return std::isfinite(value_N) ? fmt::format("{:.3f}", value_N) : "-";
}

// How much worse than the optimum, marked where constraints forbid it and where it is the same layout.
std::string distance_text(const CountAnswer& count, const JudgedLayout* layout) {
    if (layout == nullptr) return "-";
    if (layout->nodes == count.optimum.nodes && layout->method == count.optimum.method) return "same";
    return fmt::format("{:+.3f}{}", layout->difference.value_N, layout->breaks.empty() ? "" : "*");
}

std::string title_of_method(const std::string& name) {
    const FusionMethod* method = find_fusion_method(name);
    return method == nullptr ? name : std::string(method->title);
}

int indifferent_sets(const CountAnswer& count) {
    std::set<std::vector<int>> sets;
    for (const IndifferentLayout& other : count.indifferent) sets.insert(other.nodes);
    sets.erase(count.optimum.nodes);
    return static_cast<int>(sets.size());
}

// What branch and bound says of the D-optimal layouts of a long cable.
std::string d_optimal_words(const PlacementAnswer& answer) {
    double gap_nats = 0.0;
    for (const CountAnswer& count : answer.scopes.front().counts)
        gap_nats = std::max(gap_nats, count.d_optimal_gap_nats);
    return gap_nats <= 0.0
               ? "proven to tell most of all layouts of that count."
               : fmt::format("no layout of that count tells more by more than {:.3f} nats.", gap_nats);
}

std::size_t widest(const ScopeAnswer& scope, std::size_t at_least, const auto& text_of) {
    for (const CountAnswer& count : scope.counts) at_least = std::max(at_least, text_of(count).size());
    return at_least;
}

std::string scope_table(const ScopeAnswer& scope, SearchKind search) {
    const auto nodes_of = [](const CountAnswer& count) { return nodes_text(count.optimum.nodes); };
    const auto method_of = [](const CountAnswer& count) { return title_of_method(count.optimum.method); };
    const std::size_t nodes_width = widest(scope, 10, nodes_of);
    const std::size_t method_width = widest(scope, 6, method_of);
    std::string text = fmt::format("  {:>2}  {:<{}}  {:<{}}  {:>6} {:>16}  {:>7} {:>7} {:>7}  |", "m",
                                   "best nodes", nodes_width, "method", method_width, "error", "95% interval",
                                   "luck", search == SearchKind::exhaustive ? "as good" : "gap", "1 lost");
    for (const Column& column : columns) text += fmt::format(" {:>8}", column.head);
    text += "\n";
    for (const CountAnswer& count : scope.counts) {
        const JudgedLayout& best = count.optimum;
        text +=
            fmt::format("{} {:>2}  {:<{}}  {:<{}}  {:>6} {:>16}  {:>7} {:>7} {:>7}  |",
                        count.sensors == scope.recommended_count ? ">" : " ", count.sensors, nodes_of(count),
                        nodes_width, method_of(count), method_width, newtons(best.fresh.value_N),
                        fmt::format("{:.3f} to {:.3f}", best.fresh.low_N, best.fresh.high_N),
                        fmt::format("{:+.4f}", count.optimism_N),
                        search == SearchKind::exhaustive ? std::to_string(indifferent_sets(count))
                                                         : newtons(count.at_most_better_N),
                        newtons(best.after_loss_N));
        for (const Column& column : columns)
            text += fmt::format(" {:>8}", distance_text(count, find(count, column.how)));
        text += "\n";
    }
    return text;
}

ordered_json interval_json(const IntervalEstimate& estimate) {
    return {{"value_N", estimate.value_N}, {"interval_95_N", {estimate.low_N, estimate.high_N}}};
}

std::vector<int> from_one(std::vector<int> nodes) {
    for (int& node : nodes) ++node;
    return nodes;
}

ordered_json layout_json(const JudgedLayout& layout) {
    ordered_json json = {
        {"how", layout.how},
        {"nodes", from_one(layout.nodes)},
        {"method", layout.method},
        {"error_N", layout.fresh.value_N},
        {"interval_95_N", {layout.fresh.low_N, layout.fresh.high_N}},
        {"error_on_search_draws_N", layout.searched_N},
        {"difference_to_optimum", interval_json(layout.difference)},
        {"error_after_worst_loss_N",
         std::isfinite(layout.after_loss_N) ? ordered_json(layout.after_loss_N) : ordered_json()},
        {"cost", layout.cost}};
    json["breaks"] = layout.breaks;
    return json;
}

ordered_json count_json(const CountAnswer& count) {
    ordered_json json = {{"sensor_count", count.sensors},
                         {"allowed_layouts", count.allowed_layouts},
                         {"optimum", layout_json(count.optimum)},
                         {"optimism_N", count.optimism_N},
                         {"none_better_by_more_than_N", count.at_most_better_N},
                         {"d_optimal_gap_nats", count.d_optimal_gap_nats}};
    json["runners_up"] = ordered_json::array();
    for (const JudgedLayout& layout : count.runners_up) json["runners_up"].push_back(layout_json(layout));
    json["beside"] = ordered_json::array();
    for (const JudgedLayout& layout : count.beside) json["beside"].push_back(layout_json(layout));
    json["indifferent"] = ordered_json::array();
    for (const IndifferentLayout& other : count.indifferent) {
        json["indifferent"].push_back({{"nodes", from_one(other.nodes)},
                                       {"method", other.method},
                                       {"difference_N", other.difference.value_N},
                                       {"interval_95_N", {other.difference.low_N, other.difference.high_N}}});
    }
    return json;
}

}  // namespace

std::string words_of(PlacementObjective objective) {
    switch (objective) {
        case PlacementObjective::all_nodes:
            return "mean error over all nodes";
        case PlacementObjective::load_end:
            return "mean error at the load end";
        case PlacementObjective::worst_node:
            return "mean error at the worst node";
        case PlacementObjective::quantile_95:
            return "error that 95% of draws stay below";
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

std::string in_words(const StudyPlan& plan, const PlacementAnswer& answer) {
    std::string text =
        fmt::format("{}: {} of {} layouts and methods, {}, sensor noise {}\n", plan.name,
                    answer.search == SearchKind::exhaustive ? "the exact optimum" : "the best found",
                    answer.candidates, words_of(plan.placement.objective), answer.noise);
    for (const ScopeAnswer& scope : answer.scopes)
        text += "\n" + title_of(scope) + "\n" + scope_table(scope, answer.search);
    const std::string reliability =
        answer.search == SearchKind::exhaustive
            ? "as good: other layouts that these draws cannot tell from the best, all comparisons together at 95%."
            : fmt::format(
                  "gap: no layout of that count is better by more than this, if one sensor more never "
                  "hurts. D-opt: {}",
                  d_optimal_words(answer));
    const std::string legend = fmt::format(
        "m: number of sensors; > where one more no longer gains {:g} N. error: of {} fresh draws that the search has "
        "not seen; luck: how much better the search's own draws made it look. {} 1 lost: error without the sensor "
        "that is worst to lose. Right of the bar: how much worse each choice is than the best of that count, with "
        "the method that suits it best; * breaks a constraint.",
        plan.worthwhile_gain_N, answer.repetitions, reliability);
    text += "\n" + wrapped(legend, words_width, "", "") + "\n";
    return text;
}

ordered_json in_json(const StudyPlan& plan, const PlacementAnswer& answer) {
    ordered_json json = {{"name", plan.name},
                         {"seed", plan.seed},
                         {"search", answer.search == SearchKind::exhaustive ? "exhaustive" : "greedy"},
                         {"objective", name_of(plan.placement.objective)},
                         {"noise", answer.noise},
                         {"layouts", answer.layouts},
                         {"candidates", answer.candidates},
                         {"repetitions", answer.repetitions}};
    json["scopes"] = ordered_json::array();
    for (const ScopeAnswer& scope : answer.scopes) {
        ordered_json entry = {{"scope", scope.scope}};
        if (scope.scope == "regime") entry["regime"] = scope.regime;
        entry["recommended_sensor_count"] = scope.recommended_count;
        entry["counts"] = ordered_json::array();
        for (const CountAnswer& count : scope.counts) entry["counts"].push_back(count_json(count));
        json["scopes"].push_back(std::move(entry));
    }
    return json;
}

}  // namespace capstan::cli
