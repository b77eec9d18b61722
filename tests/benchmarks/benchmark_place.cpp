// The search over all layouts: 2,047 sensor sets of the paper's cable at its four instants, 2000 repetitions,
// by methods and threads. Real time is what a user waits; processor time over all threads says what it costs.
#include <benchmark/benchmark.h>

#include "capstan/search/sensor_placement.h"
#include "paper_plan.h"

namespace {

using namespace capstan;

void place(benchmark::State& bench, const std::vector<std::string>& methods) {
    StudyPlan plan = test::paper_plan(2000);
    plan.fusion_methods = methods;
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
