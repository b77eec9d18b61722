// Rate of the quasi-static step through its public API, all checks on: the paper's Sec. III.B cable (40 N preload, a
// 40 N/m spring to a wall), in partial motion (0.15 cm, 1 kHz) and mostly in mass motion (8 cm).
#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "capstan/solver/quasi_static_step.h"

namespace {

using namespace capstan;

Cable cable_of(int segments) {
    CableSpecification specification;
    specification.curvature = {{2.0, 0.28}};
    specification.segments = segments;
    specification.axial_stiffness_N = 2000.0;
    specification.dynamic_friction = 0.21;
    specification.static_friction = 0.63;
    specification.pretension_N = 40.0;
    return Cable(specification);
}

void run(benchmark::State& bench, double amplitude_m) {
    const int segments = static_cast<int>(bench.range(0));
    const Cable cable = cable_of(segments);
    const QuasiStaticStep step(cable, ModelRules::cured());
    CableState state = pretensioned(cable);
    const double rest_m = state.displacement_m.front();
    std::vector<EndConditions> cycle;
    for (int n = 0; n < 1000; ++n) {
        const double moved_m = amplitude_m * std::sin(2.0 * std::numbers::pi * n / 1000.0);
        cycle.push_back({EndCondition::position_m(rest_m + moved_m), distal_spring({40.0, 40.0, 0.0})});
    }
    std::size_t next = 0;
    long mass = 0;
    long steps = 0;
    for (auto _ : bench) {
        const StepReport report = step.advance(state, cycle[next]);
        mass += report.pattern.kind == MotionKind::mass;
        ++steps;
        benchmark::DoNotOptimize(state.tension_N.data());
        next = next + 1 < cycle.size() ? next + 1 : 0;
    }
    bench.SetItemsProcessed(bench.iterations());
    bench.counters["mass_share"] = static_cast<double>(mass) / static_cast<double>(steps);
}

void partial_motion(benchmark::State& bench) { run(bench, 0.0015); }
void mass_motion(benchmark::State& bench) { run(bench, 0.08); }

}  // namespace

BENCHMARK(partial_motion)->Arg(10)->Arg(40)->Arg(100)->Arg(1000);
BENCHMARK(mass_motion)->Arg(10)->Arg(40)->Arg(100)->Arg(1000);
