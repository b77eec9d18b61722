// Rate of the recursive estimator: a cable of 40 segments, 32 members, by sensors. `margin_over_1kHz` is how
// many times faster than a sample a millisecond it is, over the paper's cycle at 1 Hz sampled at 1 kHz. Also
// the update of the observer that controllers use.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "capstan/controller/observer.h"
#include "capstan/estimation/recursive_estimator.h"
#include "capstan/paper/compared_cycle.h"

namespace {

using namespace capstan;

void recursive(benchmark::State& bench, double amplitude_m) {
    constexpr int steps_per_cycle = 1000;
    const QuasiStaticStep model(paper::preloaded_cable(40), ModelRules::consistent());
    const CableState start = pretensioned(model.cable());
    const int sensors = static_cast<int>(bench.range(1));
    CableState truth = start;
    std::vector<double> proximal_m;
    std::vector<std::vector<TensionReading>> readings;
    for (int step = 0; step < steps_per_cycle; ++step) {
        proximal_m.push_back(start.displacement_m.front() +
                             amplitude_m * std::sin(2.0 * std::numbers::pi * step / steps_per_cycle));
        model.advance(truth, {EndCondition::position_m(proximal_m.back()), EndCondition::position_m(0.0)});
        std::vector<TensionReading> at_step;
        for (int sensor = 0; sensor < sensors; ++sensor) {
            const int node = 40 - sensor * (40 / sensors);
            TensionReading reading{spot_of_node(model.cable(), node), 0.0, {}};
            reading.value_N = truth.tension_N[static_cast<std::size_t>(node)] + 0.25 * std::sin(7.0 * step);
            reading.noise.additive_N = 0.25;
            at_step.push_back(reading);
        }
        readings.push_back(at_step);
    }
    RecursiveSettings settings;
    settings.members = static_cast<int>(bench.range(0));
    settings.wander.distal_m = 1e-5;
    RecursiveEstimator estimator(model, start, settings);
    std::size_t next = 0;
    for (auto _ : bench) {
        estimator.step({proximal_m[next], 0.0}, readings[next]);
        benchmark::DoNotOptimize(estimator.mean_N().data());
        next = next + 1 < proximal_m.size() ? next + 1 : 0;
    }
    bench.SetItemsProcessed(bench.iterations());
    bench.counters["margin_over_1kHz"] =
        benchmark::Counter(1e-3 * static_cast<double>(bench.iterations()), benchmark::Counter::kIsRate);
}

// An update of the observer of controllers: 12 segments, 32 members, a load cell at the motor and an encoder
// at the load. Of many short rounds the least is that of a core that nothing else uses.
void observer(benchmark::State& bench) {
    const Cable cable({.curvature = {{0.3, straight}, {0.314159, 0.1}, {0.585841, straight}},
                       .segments = 12,
                       .axial_stiffness_N = 9e3,
                       .dynamic_friction = 0.12,
                       .static_friction = 0.12,
                       .pretension_N = 20.0});
    Observer estimator(cable, {{false, 0.0}, {true, 0.0}}, {.noise_N = 0.2});
    std::vector<double> mean_N(13), low_N(13), high_N(13);
    long sample = 0;
    for (auto _ : bench) {
        const double reel_m = 0.002 * std::sin(2.0 * std::numbers::pi * 1e-3 * static_cast<double>(++sample));
        const double readings[] = {reel_m, 20.0 + 0.9 * reel_m * 9e3 / 1.2, -0.1 * reel_m};
        estimator.update(1e-3 * static_cast<double>(sample), readings);
        estimator.write_estimate(mean_N, low_N, high_N);
        benchmark::DoNotOptimize(mean_N.data());
    }
}

double least(const std::vector<double>& values) {
    return *std::min_element(values.begin(), values.end());
}

}  // namespace

BENCHMARK(observer)
    ->Unit(benchmark::kMicrosecond)
    ->MinTime(0.005)
    ->Repetitions(400)
    ->ReportAggregatesOnly()
    ->ComputeStatistics("least", least);
BENCHMARK_CAPTURE(recursive, partial, 0.0015)
    ->ArgNames({"members", "sensors"})
    ->ArgsProduct({{16, 32}, {1, 3}});
BENCHMARK_CAPTURE(recursive, mass, 0.01)->ArgNames({"members", "sensors"})->ArgsProduct({{16, 32}, {1, 3}});
