// Compares the speed of the closed-form step with three other solvers: a band LU factorisation (LAPACK), the
// dense solver of the paper and a generic root finder (MINPACK). The solvers take turns in the same run.
// Rates depend on the machine and its load, so compare the ratios. `race_solvers --help` says how to run it.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <vector>

#include "band_lu.h"
#include "capstan/paper/compared_cycle.h"
#include "capstan/paper/solver_comparison.h"
#include "capstan/solver/prefix_tables.h"
#include "capstan/solver/quasi_static_step.h"

namespace {

using namespace capstan;
using paper::ComparedMotion;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

paper::Peer band_lu_peer() {
    return {"band_lu", "LAPACK band LU", [](const Cable& cable) -> paper::Peer::Advance {
                return [solver = std::make_shared<reference::BandLuSolver>(cable)](
                           CableState& state, const EndConditions& ends) {
                    return solver->advance(state, ends).converged;
                };
            }};
}

// The time of the slowest step of a cycle in mass motion, after one cycle to warm up. Each step counts with
// its fastest time of three cycles, so that an interruption of the program does not count.
double slowest_step_s(int segments) {
    const Cable cable = paper::preloaded_cable(segments);
    const QuasiStaticStep step(cable, ModelRules::consistent());
    const std::vector<EndConditions> cycle = paper::cycle_of(cable, ComparedMotion::mass);
    CableState state = pretensioned(cable);
    for (const EndConditions& ends : cycle) step.advance(state, ends);
    std::vector<double> fastest_s(cycle.size(), 1e9);
    for (int repeat = 0; repeat < 3; ++repeat) {
        for (std::size_t n = 0; n < cycle.size(); ++n) {
            const auto start = Clock::now();
            step.advance(state, cycle[n]);
            fastest_s[n] = std::min(fastest_s[n], seconds_since(start));
        }
    }
    return *std::max_element(fastest_s.begin(), fastest_s.end());
}

// The memory bandwidth limit of such a step: it only writes a state from two tables, without any check.
double bare_write_s(int segments) {
    const Cable cable = paper::preloaded_cable(segments);
    const PrefixTables tables(cable, ModelRules::consistent());
    const SideTable& table = tables.proximal(sign(Direction::forward));
    CableState state = pretensioned(cable);
    double fastest_s = 1e9;
    for (int repeat = 0; repeat < 30; ++repeat) {
        const double scale_N = 1.0 + repeat;
        const auto start = Clock::now();
        for (std::size_t node = 0; node < state.tension_N.size(); ++node) {
            state.tension_N[node] = scale_N * table.tension_ratio[node];
            state.displacement_m[node] = scale_N * table.elongation_m_per_N[node];
        }
        fastest_s = std::min(fastest_s, seconds_since(start));
    }
    return fastest_s;
}

void print_race(ComparedMotion motion, int segments, double seconds_per_solver) {
    std::printf("%-8s %8d", name_of(motion).c_str(), segments);
    for (const paper::SolverRate& rate :
         paper::race({motion, segments, seconds_per_solver},
                     {band_lu_peer(), paper::linear_assumed_peer(), paper::generic_peer()})) {
        if (!rate.steps_per_s) {
            std::printf("  %24s", "above 1 s per step");
        } else if (rate.name == "closed_form") {
            std::printf("  %11.3g", *rate.steps_per_s);
        } else {
            std::printf("  %9.3g (%7.3g) %3.0f%%", *rate.steps_per_s, *rate.closed_form_is_faster_by,
                        100.0 * rate.converged_fraction);
        }
    }
    std::printf("\n");
}

constexpr const char* help_text =
    "usage: race_solvers [SECONDS]\n\n"
    "Compares the speed of the closed-form step with three other solvers on the same cable, in partial and\n"
    "in mass motion, with 10 to 1000 segments. SECONDS is the time for each solver in each case (default\n"
    "0.5); the complete comparison takes about 32 times as long. Rates depend on the machine and its load:\n"
    "compare the ratios.\n";

}  // namespace

int main(int count, char** arguments) {
    constexpr int long_cable_segments = 1'000'000;
    double seconds_per_solver = 0.5;
    if (count > 1) {
        const std::string_view argument = arguments[1];
        char* end = nullptr;
        seconds_per_solver = std::strtod(arguments[1], &end);
        const bool is_help = argument == "--help" || argument == "-h";
        if (is_help || count > 2 || *end != '\0' || !(seconds_per_solver > 0.0)) {
            std::fputs(help_text, is_help ? stdout : stderr);
            return is_help ? 0 : 2;
        }
    }
    std::printf(
        "Steps per second. For the other solvers: steps per second, in brackets the speed ratio of the closed\n"
        "form to this solver, and the percentage of steps that converged.\n\n"
        "%-8s %8s  %11s  %24s  %24s  %24s\n",
        "motion", "segments", "closed form", "band LU (LAPACK)", "dense (paper)", "root finder (MINPACK)");
    for (const ComparedMotion motion : {ComparedMotion::partial, ComparedMotion::mass}) {
        for (const int segments : {10, 40, 100, 1000}) print_race(motion, segments, seconds_per_solver);
    }
    std::printf(
        "\nA cable of %d segments in mass motion: the slowest step of a cycle takes %.3g ms. Writing its state\n"
        "alone takes %.3g ms.\n",
        long_cable_segments, 1e3 * slowest_step_s(long_cable_segments),
        1e3 * bare_write_s(long_cable_segments));
}
