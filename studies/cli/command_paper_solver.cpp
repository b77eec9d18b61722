#include <fmt/format.h>

#include <iterator>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/output.h"
#include "capstan/cli/paper_pages.h"
#include "capstan/paper/solver_comparison.h"

namespace capstan::cli {

namespace {

using paper::Agreement;
using paper::SolverRate;

struct Comparison {
    std::vector<Agreement> agreements;
    std::vector<RatesOfCable> rates;
};

Comparison measured(double seconds_per_solver) {
    Comparison comparison{paper::compare_with_generic_solver(), {}};
    for (const int segments : {1, 2, 3, 5, 10, 20, 40, 60}) {
        comparison.rates.push_back(
            {segments, paper::race({paper::ComparedMotion::partial, segments, seconds_per_solver},
                                   {paper::linear_assumed_peer(), paper::generic_peer()})});
    }
    return comparison;
}

nlohmann::ordered_json in_json(const Comparison& comparison) {
    nlohmann::ordered_json agreements = nlohmann::ordered_json::array();
    for (const Agreement& row : comparison.agreements) {
        agreements.push_back({{"motion", name_of(row.motion)},
                              {"segments", row.segments},
                              {"steps", row.steps},
                              {"converged", row.converged},
                              {"largest_difference_N", row.largest_difference_N}});
    }
    nlohmann::ordered_json rates = nlohmann::ordered_json::array();
    for (const RatesOfCable& cable : comparison.rates) {
        for (const SolverRate& rate : cable.rates) {
            nlohmann::ordered_json row = {{"segments", cable.segments}, {"solver", rate.name}};
            row["steps_per_s"] = nullptr;
            if (rate.steps_per_s) row["steps_per_s"] = *rate.steps_per_s;
            rates.push_back(row);
        }
    }
    return {{"agreement", agreements}, {"rates", rates}};
}

std::string agreement_table(const std::vector<Agreement>& rows) {
    std::string text =
        "Closed-form step and generic solver from the same state: fraction of steps in which the generic one\n"
        "converges, and largest difference of a node's tension [N]. Paper: below 1e-9 N in all conditions.\n\n";
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{:15}  {:>8}  {:>5}  {:>9}  {:>12}\n", "motion", "segments", "steps", "converged",
                   "difference");
    for (const Agreement& row : rows) {
        fmt::format_to(out, "{:15}  {:>8}  {:>5}  {:>8.1f}%  {:>12.1e}\n", name_of(row.motion), row.segments,
                       row.steps, 100.0 * row.converged / row.steps, row.largest_difference_N);
    }
    return text;
}

std::string rate_table(const std::vector<RatesOfCable>& cables) {
    std::string text = "\nSteps a second against segments, 0.15 cm at 1 kHz (the paper's Fig. 7).\n\n";
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{:>8}  {:>11}  {:>20}  {:>17}  {:>21}\n", "segments", "closed form",
                   "dense linear-assumed", "generic (MINPACK)", "closed form / generic");
    for (const RatesOfCable& cable : cables) {
        fmt::format_to(out, "{:>8}", cable.segments);
        for (const auto& [rate, width] :
             {std::pair{&cable.rates[0], 11}, {&cable.rates[1], 20}, {&cable.rates[2], 17}}) {
            fmt::format_to(out, "  {:>{}}",
                           rate->steps_per_s ? fmt::format("{:.3g}", *rate->steps_per_s) : "-", width);
        }
        const auto& ratio = cable.rates[2].closed_form_is_faster_by;
        fmt::format_to(out, "  {:>21}\n", ratio ? fmt::format("{:.3g}", *ratio) : "-");
    }
    text +=
        "\nPaper: its linear-assumed solver is over two orders of magnitude faster than MATLAB's fsolve, and takes 40\n"
        "segments at 1 kHz. Here every solver is compiled, so the generic one has no interpreter to carry.\n";
    for (const RatesOfCable& cable : cables) {
        if (cable.segments != 40 || !cable.rates[0].steps_per_s) continue;
        fmt::format_to(std::back_inserter(text), "Ours: 40 segments at {:.3g} kHz.\n",
                       1e-3 * *cable.rates[0].steps_per_s);
    }
    return text;
}

ExitCode run(const Invocation& invocation) {
    const Comparison comparison = measured(invocation.real("seconds"));
    deliver_page(invocation, [&] {
        return reports::experiment_page_html(solver_page(comparison.agreements, comparison.rates));
    });
    deliver(invocation, invocation.has("json")
                            ? json_text(in_json(comparison))
                            : agreement_table(comparison.agreements) + rate_table(comparison.rates));
    return ExitCode::success;
}

}  // namespace

Command paper_solver_command() {
    return {
        "paper solver",
        "Repeat the paper's comparison of solvers (Sec. III.B, Fig. 7).",
        "Checks the closed-form step against a generic root finder on the same equations, step by step: fraction of steps "
        "in which the root finder converges and largest difference of tension, in mass, partial, mono- and "
        "bidirectional motion, 1 to 60 segments. Then rates against the number of segments, beside what the paper "
        "says of its own.",
        {},
        {{"seconds",
          '\0',
          OptionKind::real_number,
          "S",
          "Time for each solver and number of segments.",
          "0.1",
          {},
          0.01,
          60},
         output_option,
         page_option,
         json_option,
         help_option},
        {"capstan paper solver", "capstan paper solver --html solver.html",
         "capstan paper solver --json -o solver.json"},
        run};
}

}  // namespace capstan::cli
