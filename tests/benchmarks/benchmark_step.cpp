// Rates of the quasi-static step through its public API, with all checks: the paper's Sec. III.B cable in
// partial motion (0.15 cm, 1 kHz) and mostly in mass motion (8 cm).
#include <benchmark/benchmark.h>

#include <vector>

#include "capstan/paper/compared_cycle.h"
#include "capstan/solver/quasi_static_step.h"

namespace {

using namespace capstan;
using paper::ComparedMotion;

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

}  // namespace

BENCHMARK_CAPTURE(closed_form, partial, ComparedMotion::partial)->Arg(10)->Arg(40)->Arg(100)->Arg(1000);
BENCHMARK_CAPTURE(closed_form, mass, ComparedMotion::mass)->Arg(10)->Arg(40)->Arg(100)->Arg(1000);
