#include "capstan/cli/page_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "capstan/cli/place_words.h"
#include "capstan/cli/program.h"
#include "capstan/config/config_writer.h"
#include "capstan/estimation/fusion_method.h"
#include "capstan/sensing/layout.h"

namespace capstan::cli {

namespace {

using reports::NumberTable;
using reports::Table;

std::string title_of_choice(const std::string& how) {
    if (how == "optimum") return "best layout";
    if (how == "greedy_forward") return "greedy forward";
    if (how == "greedy_backward") return "greedy backward";
    if (how == "d_optimal") return "D-optimal";
    const LayoutFamily* family = find_layout_family(how);
    return family == nullptr ? how : std::string(family->title);
}

bool is_family(const JudgedLayout& layout) {
    return find_layout_family(layout.how) != nullptr;
}

Table error_table(const PlacementAnswer& answer) {
    Table table{"place_error",
                "Error of the best layout and of the families, on fresh draws",
                {"question", "choice", "sensor_count", "nodes", "method_title", "error_N", "interval_low_N",
                 "interval_high_N"},
                {}};
    const auto add = [&](const ScopeAnswer& scope, const CountAnswer& count, const JudgedLayout& layout) {
        table.rows.push_back({title_of(scope), title_of_choice(layout.how), std::int64_t{count.sensors},
                              nodes_as_people_count(layout.nodes),
                              std::string(find_fusion_method(layout.method)->title), layout.fresh.value_N,
                              layout.fresh.low_N, layout.fresh.high_N});
    };
    for (const ScopeAnswer& scope : answer.scopes) {
        for (const CountAnswer& count : scope.counts) {
            add(scope, count, count.optimum);
            for (const JudgedLayout& layout : count.beside) {
                if (is_family(layout)) add(scope, count, layout);
            }
        }
    }
    return table;
}

// One row for each sensor of the best layouts.
Table node_table(const PlacementAnswer& answer) {
    Table table{"place_node",
                "Nodes of the best layout of each number of sensors",
                {"question", "sensor_count", "node", "error_N"},
                {}};
    for (const ScopeAnswer& scope : answer.scopes) {
        for (const CountAnswer& count : scope.counts) {
            for (const int node : count.optimum.nodes) {
                table.rows.push_back({title_of(scope), std::int64_t{count.sensors}, std::int64_t{node + 1},
                                      count.optimum.fresh.value_N});
            }
        }
    }
    return table;
}

std::string newtons(double value_N) {
    return std::isfinite(value_N) ? fmt::format("{:.3f}", value_N) : "-";
}

NumberTable numbers_of(const ScopeAnswer& scope) {
    NumberTable numbers{
        title_of(scope),
        {"Sensors", "Best nodes", "Method", "Error", "95% interval", "Luck of the search", "As good",
         "After a loss", "Even", "Distal", "Both", "Greedy forward", "Greedy backward", "D-optimal"},
        {}};
    for (const CountAnswer& count : scope.counts) {
        const JudgedLayout& best = count.optimum;
        std::vector<std::string> row = {
            std::to_string(count.sensors) +
                (count.sensors == scope.recommended_count ? " (recommended)" : ""),
            nodes_as_people_count(best.nodes),
            std::string(find_fusion_method(best.method)->title),
            newtons(best.fresh.value_N),
            fmt::format("{:.3f} to {:.3f}", best.fresh.low_N, best.fresh.high_N),
            fmt::format("{:+.4f}", count.optimism_N),
            std::to_string(count.indifferent.size()),
            newtons(best.after_loss_N)};
        for (const char* how : {"even", "distal", "both", "greedy_forward", "greedy_backward", "d_optimal"}) {
            const auto found = std::find_if(count.beside.begin(), count.beside.end(),
                                            [&](const JudgedLayout& layout) { return layout.how == how; });
            row.push_back(found == count.beside.end() ? "-"
                                                      : fmt::format("{:+.3f}{}", found->difference.value_N,
                                                                    found->breaks.empty() ? "" : " *"));
        }
        numbers.rows.push_back(std::move(row));
    }
    return numbers;
}

std::string verdict_of(const PlacementAnswer& answer) {
    const ScopeAnswer& scope = answer.scopes.back();  // the duty cycle
    for (const CountAnswer& count : scope.counts) {
        if (count.sensors != scope.recommended_count) continue;
        return fmt::format(
            "Over the duty cycle, {} {} {}, fused by {}: {:.3f} N of error ({:.3f} to {:.3f} N); one more "
            "sensor is not worth it.",
            count.sensors, count.sensors == 1 ? "sensor at node" : "sensors at nodes",
            nodes_as_people_count(count.optimum.nodes), find_fusion_method(count.optimum.method)->title,
            count.optimum.fresh.value_N, count.optimum.fresh.low_N, count.optimum.fresh.high_N);
    }
    return "";
}

}  // namespace

reports::ExperimentPage place_page(const StudyPlan& plan, const PlacementAnswer& answer) {
    reports::ExperimentPage page;
    page.id = "place";
    page.kind = answer.search == SearchKind::exhaustive ? "All layouts, searched exactly"
                                                        : "A long cable, searched greedily";
    page.title = plan.name;
    page.verdict = verdict_of(answer);
    page.sections = {
        {"error",
         "What more sensors, and better places, are worth",
         fmt::format(
             "{} candidates (layouts times fusion methods) on the same {} draws of sensor noise {}; judged "
             "by the {}, on as many fresh draws.",
             answer.candidates, answer.repetitions, answer.noise, words_of(plan.placement.objective)),
         {},
         ""},
        {"nodes", "Where the sensors go", "", {}, ""}};
    reports::ExperimentSection numbers{
        "numbers",
        "In numbers",
        "Newtons. As good: candidates that the draws cannot tell from the best. The last columns say how much worse each choice "
        "is than the best of that count; * breaks a constraint.",
        {},
        ""};
    for (const ScopeAnswer& scope : answer.scopes) numbers.numbers.push_back(numbers_of(scope));
    page.sections.push_back(std::move(numbers));
    page.tables = {error_table(answer), node_table(answer)};
    page.config_text = config::config_text(plan, config::Comments::none);
    page.program_version = program_version();
    return page;
}

}  // namespace capstan::cli
