#include <fmt/format.h>

#include <iterator>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/output.h"
#include "capstan/paper/solver_comparison.h"

namespace capstan::cli {

namespace {

using paper::ComparedMotion;
using paper::Solver;
using paper::SolverRate;

constexpr int long_cable_segments = 1'000'000;

struct Race {
    std::string_view name;
    int segments = 0;
    std::vector<SolverRate> rates;
};

struct Bench {
    std::vector<Race> races;
    double slowest_step_s = 0.0;  // of the long cable
};

Bench measured(double seconds_per_solver) {
    Bench bench;
    for (const auto& [name, motion] :
         {std::pair{"paper", ComparedMotion::partial}, {"mass", ComparedMotion::mass}}) {
        for (const int segments : {10, 40, 100, 1000}) {
            bench.races.push_back({name, segments,
                                   paper::race({motion, segments, seconds_per_solver},
                                               {Solver::closed_form, Solver::band_lu, Solver::linear_assumed,
                                                Solver::generic})});
        }
    }
    bench.slowest_step_s = paper::slowest_step_s(long_cable_segments);
    return bench;
}

nlohmann::ordered_json in_json(const Bench& bench) {
    nlohmann::ordered_json races = nlohmann::ordered_json::array();
    for (const Race& race : bench.races) {
        for (const SolverRate& rate : race.rates) {
            nlohmann::ordered_json row = {
                {"case", race.name}, {"segments", race.segments}, {"solver", name_of(rate.solver)}};
            row["steps_per_s"] = nullptr;
            row["closed_form_is_faster_by"] = nullptr;
            row["converged_share"] = nullptr;
            if (rate.steps_per_s) {
                row["steps_per_s"] = *rate.steps_per_s;
                row["closed_form_is_faster_by"] = *rate.closed_form_is_faster_by;
                row["converged_share"] = rate.converged_share;
            }
            races.push_back(row);
        }
    }
    return {{"rates", races},
            {"long_cable", {{"segments", long_cable_segments}, {"slowest_step_s", bench.slowest_step_s}}}};
}

std::string in_words(const Bench& bench) {
    std::string text = "Steps a second; in brackets how many times as fast the closed-form step is.\n\n";
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{:5}  {:>8}  {:>11}  {:>20}  {:>20}  {:>20}\n", "case", "segments", "closed form",
                   "LAPACK band LU", "dense linear-assumed", "generic (MINPACK)");
    std::string failures;
    for (const Race& race : bench.races) {
        fmt::format_to(out, "{:5}  {:>8}", race.name, race.segments);
        for (const SolverRate& rate : race.rates) {
            if (rate.solver == Solver::closed_form) {
                fmt::format_to(out, "  {:>11.3g}", *rate.steps_per_s);
                continue;
            }
            const std::string cell = rate.steps_per_s ? fmt::format("{:.3g} ({:.3g})", *rate.steps_per_s,
                                                                    *rate.closed_form_is_faster_by)
                                                      : "over 1 s a step";
            fmt::format_to(out, "  {:>20}", cell);
            if (rate.steps_per_s && rate.converged_share < 1.0) {
                failures +=
                    fmt::format("{} converged in {:.2f}% of the steps of case {} with {} segments.\n",
                                name_of(rate.solver), 100.0 * rate.converged_share, race.name, race.segments);
            }
        }
        text += "\n";
    }
    if (!failures.empty()) text += "\n" + failures;
    fmt::format_to(out, "\nSlowest step of a cycle (mass) with {} segments: {:.3g} ms.\n",
                   long_cable_segments, 1e3 * bench.slowest_step_s);
    return text;
}

ExitCode run(const Invocation& invocation) {
    const Bench bench = measured(invocation.real("seconds"));
    deliver(invocation, invocation.has("json") ? json_text(in_json(bench)) : in_words(bench));
    return ExitCode::success;
}

}  // namespace

Command bench_solver_command() {
    return {
        "bench solver",
        "Race the closed-form step against compiled peers.",
        "Runs the closed-form step beside LAPACK's band LU, the paper's dense linear-assumed solver and a generic root "
        "finder (MINPACK's hybrid), in the same run and in turns, and prints steps a second and ratios. Cable of the "
        "paper's Sec. III.B (Table I, 40 N preload, 40 N/m spring to a wall), 1000 steps a cycle: case paper is "
        "0.15 cm, case mass 8 cm. Then the slowest step of a cable of 1,000,000 segments. Rates move with the "
        "machine and with what else it does; compare ratios.",
        {},
        {{"seconds",
          '\0',
          OptionKind::real_number,
          "S",
          "Time for each solver, case and number of segments.",
          "0.5",
          {},
          0.01,
          60},
         output_option,
         json_option,
         help_option},
        {"capstan bench solver", "capstan bench solver --seconds 2 --json -o rates.json"},
        run};
}

}  // namespace capstan::cli
