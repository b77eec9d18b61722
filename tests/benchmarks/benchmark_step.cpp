// Rates of the quasi-static step through its public API, with all checks: the paper's Sec. III.B cable in
// partial motion (0.15 cm, 1 kHz) and mostly in mass motion (8 cm); one cable, and 64 in the lanes of an
// ensemble, each with its own friction and stiffness. Items are steps of one cable.
#include <benchmark/benchmark.h>

#include <vector>

#include "capstan/paper/compared_cycle.h"
#include "capstan/solver/cable_ensemble.h"
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

void ensemble(benchmark::State& bench, ComparedMotion motion) {
    constexpr int members = 64;
    const Cable cable = paper::preloaded_cable(static_cast<int>(bench.range(0)));
    const std::vector<EndConditions> cycle = paper::cycle_of(cable, motion);
    CableEnsemble cables(cable, members);
    for (int j = 0; j < members; ++j) {
        for (int segment = 0; segment < cables.segments(); ++segment)
            cables.sliding_exponent(segment)[j] *= 0.9 + 0.2 * j / members;
        cables.compliance_m_per_N()[j] *= 0.9 + 0.2 * (members - j) / members;
    }
    cables.retune();
    std::vector<double> value(members);
    std::size_t next = 0;
    double at_m = pretensioned(cable).displacement_m.front();
    long searched = 0;
    for (auto _ : bench) {
        const EndConditions& ends = cycle[next];
        const double to_m = ends.proximal.value / ends.proximal.displacement_factor;
        value.assign(members, ends.distal.value);
        searched +=
            cables.advance(to_m - at_m, {ends.distal.displacement_factor, ends.distal.tension_factor, value})
                .searched;
        at_m = to_m;
        benchmark::DoNotOptimize(cables.tension_N(0).data());
        next = next + 1 < cycle.size() ? next + 1 : 0;
    }
    bench.SetItemsProcessed(bench.iterations() * members);
    bench.counters["searched_fraction"] =
        static_cast<double>(searched) / static_cast<double>(bench.iterations() * members);
}

}  // namespace

BENCHMARK_CAPTURE(ensemble, partial, ComparedMotion::partial)->Arg(12);
BENCHMARK_CAPTURE(ensemble, mass, ComparedMotion::mass)->Arg(12);
BENCHMARK_CAPTURE(closed_form, partial, ComparedMotion::partial)->Arg(12);
BENCHMARK_CAPTURE(closed_form, mass, ComparedMotion::mass)->Arg(12);
BENCHMARK_CAPTURE(closed_form, partial, ComparedMotion::partial)->Arg(10)->Arg(40)->Arg(100)->Arg(1000);
BENCHMARK_CAPTURE(closed_form, mass, ComparedMotion::mass)->Arg(10)->Arg(40)->Arg(100)->Arg(1000);
