#include <fmt/format.h>

#include <iterator>
#include <optional>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/output.h"
#include "capstan/cli/speed_targets.h"
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
    double bare_write_s = 0.0;    // of its state
    std::vector<SpeedTarget> targets;
};

// Of one solver in one race; nothing where it was too slow to be raced.
std::optional<SolverRate> rate_of(const Bench& bench, std::string_view name, int segments, Solver solver) {
    for (const Race& race : bench.races) {
        if (race.name != name || race.segments != segments) continue;
        for (const SolverRate& rate : race.rates) {
            if (rate.solver == solver && rate.steps_per_s) return rate;
        }
    }
    return std::nullopt;
}

// What the project has set itself; targets that need more than this program (Octave) are not among them.
std::vector<SpeedTarget> targets_of(const Bench& bench) {
    std::vector<SpeedTarget> targets;
    const auto add = [&](const char* what, const char* unit, double target, bool at_least,
                         const std::optional<double>& measured) {
        if (measured) targets.push_back({what, unit, target, *measured, at_least});
    };
    const auto rate = [&](int segments, Solver solver) { return rate_of(bench, "mass", segments, solver); };
    const auto alone = [&](int segments) { return *rate(segments, Solver::closed_form)->steps_per_s; };
    const auto faster_than = [&](Solver peer) -> std::optional<double> {
        const auto found = rate(40, peer);
        return found ? found->closed_form_is_faster_by : std::nullopt;
    };
    add("mass, 40 segments: one step", "steps/s", 20e6, true, alone(40));
    add("mass, 40 segments: against LAPACK band LU", "times", 80.0, true, faster_than(Solver::band_lu));
    add("mass, 40 segments: against dense linear-assumed", "times", 500.0, true,
        faster_than(Solver::linear_assumed));
    add("mass, 1000 segments: a step, for each node", "ns", 0.4, false, 1e9 / alone(1000) / 1001.0);
    add("mass, 10 segments: replicates against one by one", "times", 3.0, true,
        1.0 / *rate(10, Solver::replicates)->closed_form_is_faster_by);
    add("mass, 1,000,000 segments: slowest step of a cycle", "ms", 1.0, false, 1e3 * bench.slowest_step_s);
    return targets;
}

Bench measured(double seconds_per_solver) {
    Bench bench;
    for (const auto& [name, motion] :
         {std::pair{"paper", ComparedMotion::partial}, {"mass", ComparedMotion::mass}}) {
        for (const int segments : {10, 40, 100, 1000}) {
            bench.races.push_back({name, segments,
                                   paper::race({motion, segments, seconds_per_solver},
                                               {Solver::closed_form, Solver::replicates, Solver::band_lu,
                                                Solver::linear_assumed, Solver::generic})});
        }
    }
    bench.slowest_step_s = paper::slowest_step_s(long_cable_segments);
    bench.bare_write_s = paper::bare_write_s(long_cable_segments);
    bench.targets = targets_of(bench);
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
            row["converged_fraction"] = nullptr;
            if (rate.steps_per_s) {
                row["steps_per_s"] = *rate.steps_per_s;
                row["closed_form_is_faster_by"] = *rate.closed_form_is_faster_by;
                row["converged_fraction"] = rate.converged_fraction;
            }
            races.push_back(row);
        }
    }
    nlohmann::ordered_json targets = nlohmann::ordered_json::array();
    for (const SpeedTarget& target : bench.targets) {
        targets.push_back({{"what", target.what},
                           {"unit", target.unit},
                           {"measured", target.measured},
                           {target.at_least ? "at_least" : "at_most", target.target},
                           {"met", target.met()}});
    }
    return {{"rates", races},
            {"long_cable",
             {{"segments", long_cable_segments},
              {"slowest_step_s", bench.slowest_step_s},
              {"bare_write_s", bench.bare_write_s}}},
            {"targets", targets}};
}

std::string in_words(const Bench& bench) {
    std::string text = "Steps a second; in brackets how many times as fast the closed-form step is.\n\n";
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{:5}  {:>8}  {:>11}  {:>16}  {:>20}  {:>20}  {:>20}\n", "case", "segments",
                   "closed form", "64 replicates", "LAPACK band LU", "dense linear-assumed",
                   "generic (MINPACK)");
    std::string failures;
    for (const Race& race : bench.races) {
        fmt::format_to(out, "{:5}  {:>8}", race.name, race.segments);
        for (const SolverRate& rate : race.rates) {
            if (rate.solver == Solver::closed_form) {
                fmt::format_to(out, "  {:>11.3g}", *rate.steps_per_s);
                continue;
            }
            if (rate.solver == Solver::replicates) {
                fmt::format_to(
                    out, "  {:>16}",
                    fmt::format("{:.3g} ({:.2g})", *rate.steps_per_s, *rate.closed_form_is_faster_by));
                continue;
            }
            const std::string cell = rate.steps_per_s ? fmt::format("{:.3g} ({:.3g})", *rate.steps_per_s,
                                                                    *rate.closed_form_is_faster_by)
                                                      : "over 1 s a step";
            fmt::format_to(out, "  {:>20}", cell);
            if (rate.steps_per_s && rate.converged_fraction < 1.0) {
                failures += fmt::format("{} converged in {:.2f}% of the steps of case {} with {} segments.\n",
                                        name_of(rate.solver), 100.0 * rate.converged_fraction, race.name,
                                        race.segments);
            }
        }
        text += "\n";
    }
    if (!failures.empty()) text += "\n" + failures;
    fmt::format_to(
        out,
        "\nSlowest step of a cycle (mass) with {} segments: {:.3g} ms; only writing its state, with no "
        "check: {:.3g} ms.\n\n",
        long_cable_segments, 1e3 * bench.slowest_step_s, 1e3 * bench.bare_write_s);
    return text + in_words(bench.targets);
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
        "0.15 cm, case mass 8 cm. Replicates are 64 cables in vectors, strokes within 10%, counted in one cable's steps. "
        "Then the slowest step of a cable of 1,000,000 segments, and the speeds that the project has set itself: met, "
        "or short by how much. Rates move with the machine and with what else it does; compare ratios.",
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
