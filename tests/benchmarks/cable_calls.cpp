// The C++ side of python_overhead.py: processor time in seconds of one batch simulation and of one observer
// update, the least of several, on one line.
#include <sys/mman.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <new>
#include <numbers>

#include "capstan/cable/cable_state.h"
#include "capstan/cable/conduit.h"
#include "capstan/cable_paths/cable_paths.h"
#include "capstan/estimation/recursive_estimator.h"

namespace {

using namespace capstan;

template <class Work>
double shortest_s(int times, const Work& work) {
    double least = 1e9;
    for (int k = 0; k < times; ++k) {
        const std::clock_t start = std::clock();
        work();
        least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return least;
}

// New memory in large pages, as the Python module has it for its arrays: both sides pay the same for memory.
std::unique_ptr<double[], decltype(&std::free)> in_large_pages(std::size_t size) {
    constexpr std::size_t page_bytes = std::size_t{2} << 20;
    const std::size_t bytes = (size * sizeof(double) + page_bytes - 1) / page_bytes * page_bytes;
    std::unique_ptr<double[], decltype(&std::free)> memory(
        static_cast<double*>(std::aligned_alloc(page_bytes, bytes)), &std::free);
    if (memory == nullptr) throw std::bad_alloc();
    madvise(memory.get(), bytes, MADV_HUGEPAGE);
    return memory;
}

double batch_s() {
    const Cable cable({.curvature = pieces_of({{90.0 * rad_per_degree, 0.08, 0.6}}, 2.0),
                       .segments = 40,
                       .axial_stiffness_N = 9e3,
                       .dynamic_friction = 0.12,
                       .static_friction = 0.12,
                       .pretension_N = 20.0});
    CableMotion motion{{}, SpringLoad{3000.0}};
    for (int time = 0; time < 1000; ++time) motion.motor_m.push_back(0.01 * std::sin(0.02 * time));
    CableDraws draws;
    for (int draw = 0; draw < 128; ++draw) draws.friction.push_back(0.05 + 0.001 * draw);
    const std::size_t size = 128 * 1000 * 41;
    return shortest_s(15, [&] {
        const auto tension_N = in_large_pages(size);
        const auto displacement_m = in_large_pages(size);
        simulate_paths(cable, motion, draws, 1, {{tension_N.get(), size}, {displacement_m.get(), size}});
    });
}

double update_s() {
    const QuasiStaticStep step(Cable({.curvature = pieces_of({{std::numbers::pi, 0.1, 0.3}}, 1.2),
                                      .segments = 12,
                                      .axial_stiffness_N = 9e3,
                                      .dynamic_friction = 0.1,
                                      .static_friction = 0.1,
                                      .pretension_N = 20.0}),
                               ModelRules::consistent());
    const CableState start = pretensioned(step.cable());
    constexpr int updates = 2000;
    return shortest_s(15,
                      [&] {
                          RecursiveEstimator estimator(step, start, {.wander = {.distal_m = 1e-4}});
                          for (int k = 0; k < updates; ++k) {
                              const TensionReading reading{
                                  {0, 0.0}, 20.0 + 5.0 * std::sin(0.01 * k), {.additive_N = 0.2}};
                              estimator.step({start.displacement_m.front() - 0.002 * std::sin(0.01 * k), 0.0},
                                             {&reading, 1});
                          }
                      }) /
           updates;
}

}  // namespace

int main() {
    std::printf("%.9f %.9f\n", batch_s(), update_s());
    return 0;
}
