// Rates of the quasi-static step through its public API, all checks on, and of the compiled peers from the
// same states: the paper's Sec. III.B cable in partial motion (0.15 cm, 1 kHz) and mostly in mass motion (8
// cm).
#include <benchmark/benchmark.h>

#include <vector>

#include "capstan/paper/compared_cycle.h"
#include "capstan/paper/compared_solvers.h"
#include "capstan/solver/replicate_step.h"

namespace {

using namespace capstan;
using paper::ComparedMotion;
using paper::Solver;

void closed_form(benchmark::State& bench, ComparedMotion motion) {
    const Cable cable = paper::preloaded_cable(static_cast<int>(bench.range(0)));
    const QuasiStaticStep step(cable, ModelRules::consistent());
    const std::vector<EndConditions> cycle = paper::cycle_of(cable, motion);
    CableState state = pretensioned(cable);
    std::size_t next = 0;
    long mass = 0;
    for (auto _ : bench) {
        const StepReport report = step.advance(state, cycle[next]);
        mass += report.pattern.kind == MotionKind::mass;
        benchmark::DoNotOptimize(state.tension_N.data());
        next = next + 1 < cycle.size() ? next + 1 : 0;
    }
    bench.SetItemsProcessed(bench.iterations());
    bench.counters["mass_fraction"] = static_cast<double>(mass) / static_cast<double>(bench.iterations());
}

// Items are steps of one replicate.
void replicates(benchmark::State& bench, ComparedMotion motion) {
    constexpr int count = 64;
    const Cable cable = paper::preloaded_cable(static_cast<int>(bench.range(0)));
    const ReplicateStep step(cable, ModelRules::consistent());
    std::vector<ReplicateEnds> cycle(paper::steps_per_cycle, ReplicateEnds(count));
    for (int replicate = 0; replicate < count; ++replicate) {
        const auto ends = paper::cycle_of(cable, motion, 0.9 + 0.2 * replicate / count);
        for (std::size_t n = 0; n < cycle.size(); ++n) cycle[n].set(replicate, ends[n]);
    }
    ReplicateStates states(pretensioned(cable), count);
    std::size_t next = 0;
    long one_by_one = 0;
    for (auto _ : bench) {
        one_by_one += step.advance(states, cycle[next]).one_by_one;
        next = next + 1 < cycle.size() ? next + 1 : 0;
    }
    bench.SetItemsProcessed(bench.iterations() * count);
    bench.counters["one_by_one_fraction"] =
        static_cast<double>(one_by_one) / static_cast<double>(bench.iterations() * count);
}

// Each step from the true state before it, evenly over the cycle; the copy of the state counts for nothing
// here.
void peer(benchmark::State& bench, ComparedMotion motion, Solver solver) {
    const Cable cable = paper::preloaded_cable(static_cast<int>(bench.range(0)));
    const std::vector<EndConditions> cycle = paper::cycle_of(cable, motion);
    const QuasiStaticStep step(cable, ModelRules::consistent());
    std::vector<CableState> before;
    CableState state = pretensioned(cable);
    for (const EndConditions& ends : cycle) {
        before.push_back(state);
        step.advance(state, ends);
    }
    const paper::Advance advance = paper::advance_of(solver, cable);
    const std::size_t stride = 619;  // prime to the cycle, near its golden section
    std::size_t next = 0;
    long converged = 0;
    for (auto _ : bench) {
        state = before[next];
        converged += advance(state, cycle[next]).converged;
        next = (next + stride) % cycle.size();
    }
    bench.SetItemsProcessed(bench.iterations());
    bench.counters["converged_fraction"] =
        static_cast<double>(converged) / static_cast<double>(bench.iterations());
}

}  // namespace

BENCHMARK_CAPTURE(closed_form, partial, ComparedMotion::partial)->Arg(10)->Arg(40)->Arg(100)->Arg(1000);
BENCHMARK_CAPTURE(closed_form, mass, ComparedMotion::mass)->Arg(10)->Arg(40)->Arg(100)->Arg(1000);
BENCHMARK_CAPTURE(replicates, partial, ComparedMotion::partial)->Arg(10)->Arg(40);
BENCHMARK_CAPTURE(replicates, mass, ComparedMotion::mass)->Arg(10)->Arg(40)->Arg(100);
BENCHMARK_CAPTURE(peer, mass_band_lu, ComparedMotion::mass, Solver::band_lu)->Arg(10)->Arg(40)->Arg(100);
BENCHMARK_CAPTURE(peer, mass_linear_assumed, ComparedMotion::mass, Solver::linear_assumed)->Arg(10)->Arg(40);
BENCHMARK_CAPTURE(peer, mass_generic, ComparedMotion::mass, Solver::generic)->Arg(10)->Arg(40);
