#include "trajectories.h"

#include <cmath>
#include <numbers>
#include <random>

namespace capstan::test {

std::vector<EndConditions> sine_against_locked_end(const Cable& cable, double amplitude_m,
                                                   int samples_per_cycle, int samples) {
    const double rest_m = pretensioned(cable).displacement_m.front();
    std::vector<EndConditions> ends;
    for (int n = 1; n <= samples; ++n) {
        const double moved_m = amplitude_m * std::sin(2.0 * std::numbers::pi * n / samples_per_cycle);
        ends.push_back({EndCondition::position_m(rest_m + moved_m), EndCondition::position_m(0.0)});
    }
    return ends;
}

std::vector<std::pair<double, double>> both_ends_wander(int samples, double step_m, unsigned seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
    const double a = phase(random);
    const double b = phase(random);
    const double period = 180.0;  // samples
    const double amplitude_m = step_m * period / (2.0 * std::numbers::pi);
    std::vector<std::pair<double, double>> path;
    for (int n = 0; n < samples; ++n) {
        const double angle = 2.0 * std::numbers::pi * n / period;
        path.emplace_back(0.5 * amplitude_m * (std::sin(angle + a) - std::sin(a)),
                          0.3 * amplitude_m * (std::sin(1.37 * angle + b) - std::sin(b)));
    }
    return path;
}

}  // namespace capstan::test
