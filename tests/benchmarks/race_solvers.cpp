// Races the closed-form step against compiled peers: LAPACK's band LU, the paper's dense linear-assumed
// solver and a generic root finder, in turns and in the same run. Rates change with the machine and its load,
// so compare ratios. Run by hand: race_solvers [seconds per solver, case and number of segments].
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
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

// The slowest step of a cycle in mass motion, after one cycle to warm up. Each step counts with the fastest
// of three cycles, so that it is not blamed for an interruption.
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

// The memory's lower limit for such a step: only writing a state from two tables, without any check.
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
            std::printf("  %24s", "over 1 s a step");
        } else if (rate.name == "closed_form") {
            std::printf("  %11.3g", *rate.steps_per_s);
        } else {
            std::printf("  %9.3g (%7.3g) %3.0f%%", *rate.steps_per_s, *rate.closed_form_is_faster_by,
                        100.0 * rate.converged_fraction);
        }
    }
    std::printf("\n");
}

}  // namespace

int main(int count, char** arguments) {
    constexpr int long_cable_segments = 1'000'000;
    const double seconds_per_solver = count > 1 ? std::atof(arguments[1]) : 0.5;
    std::printf(
        "Steps a second; in brackets how many times as fast the closed form is; fraction that converged.\n"
        "%-8s %8s  %11s  %24s  %24s  %24s\n",
        "case", "segments", "closed form", "LAPACK band LU", "dense linear-assumed", "generic (MINPACK)");
    for (const ComparedMotion motion : {ComparedMotion::partial, ComparedMotion::mass}) {
        for (const int segments : {10, 40, 100, 1000}) print_race(motion, segments, seconds_per_solver);
    }
    std::printf(
        "Slowest step of a cycle in mass motion with %d segments: %.3g ms; only writing its state: %.3g ms.\n",
        long_cable_segments, 1e3 * slowest_step_s(long_cable_segments),
        1e3 * bare_write_s(long_cable_segments));
}
