// The search over all layouts: 2,047 sensor sets of the paper's cable at its four instants, 2000 repetitions,
// by methods and threads. Real time is what a user waits; processor time over all threads says what it costs.
#include <benchmark/benchmark.h>

#include "capstan/estimation/fusion_method.h"
#include "capstan/placement/sensor_placement.h"

namespace {

using namespace capstan;

StudyPlan paper_plan(std::vector<std::string> methods) {
    StudyPlan plan;
    plan.name = "all layouts of the paper's cable";
    plan.repetitions = 2000;
    CableSpecification& cable = plan.transmission.cable;
    cable.curvature = {{2.0, 0.28}};
    cable.segments = 10;
    cable.axial_stiffness_N = 2000.0;
    cable.dynamic_friction = 0.21;
    cable.static_friction = 0.63;
    cable.pretension_N = 10.0;
    plan.transmission.rules = ModelRules::paper();
    plan.motion.sample_rate_Hz = 100.0;
    plan.motion.samples = 200;
    plan.motion.proximal = {EndKind::position, 0.01, 1.0, 0.0, 0.0};
    plan.regimes = {{Regime::mass, {112, 142}, 0.5}, {Regime::partial_proximal, {6, 104}, 0.5}};
    plan.noise_levels = {{"10 %", {.multiplicative_ratio = 0.1}}};
    plan.layout_families = {"even"};
    plan.sensor_counts = {1};
    plan.fusion_methods = std::move(methods);
    plan.largest_distal_increment_m = 0.00063;
    return plan;
}

void place(benchmark::State& bench, const std::vector<std::string>& methods) {
    const StudyPlan plan = paper_plan(methods);
    PlacementOptions options;
    options.jobs = static_cast<int>(bench.range(0));
    for (auto _ : bench) benchmark::DoNotOptimize(place_sensors(plan, options).layouts);
}

const std::vector<std::string> paper_and_likelihood = {"mean", "mean_r", "w_mean", "w_mean_r",
                                                       "maximum_likelihood"};

}  // namespace

BENCHMARK_CAPTURE(place, paper_and_likelihood, paper_and_likelihood)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(place, posterior_mean, std::vector<std::string>{"posterior_mean"})
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMillisecond);
