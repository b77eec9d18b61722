// Estimates the tension everywhere from two noisy sensors, as a device at 1 kHz would: nobody measures the
// far end.
#include <capstan/estimation/recursive_estimator.h>

#include <cmath>
#include <cstdio>
#include <random>

int main() {
    const capstan::Cable cable({
        .curvature = {{.length_m = 0.4}, {.length_m = 0.8, .bend_radius_m = 0.25}},
        .segments = 40,
        .axial_stiffness_N = 2000.0,
        .dynamic_friction = 0.15,
        .static_friction = 0.2,
        .pretension_N = 20.0,
    });
    const capstan::QuasiStaticStep model(cable, capstan::ModelRules::consistent());
    capstan::CableState truth = capstan::pretensioned(cable);
    const double start_m = truth.displacement_m.front();
    capstan::RecursiveEstimator estimator(model, truth, {.wander = {.distal_m = 1e-4}});

    constexpr double noise_N = 0.5;
    std::mt19937 generator(1);
    std::normal_distribution<double> noise(0.0, noise_N);
    double squared_N2 = 0.0;
    int held = 0;
    constexpr int samples = 1000;  // a second
    for (int sample = 1; sample <= samples; ++sample) {
        const double phase = 2.0 * M_PI * sample / samples;
        const double proximal_m = start_m - 0.01 * std::sin(phase);
        const double distal_m = 0.004 * (1.0 - std::cos(phase));  // a person moves it
        model.advance(truth, {capstan::EndCondition::position_m(proximal_m),
                              capstan::EndCondition::position_m(distal_m)});

        const int near_motor = 4;
        const int near_load = 36;
        const capstan::TensionReading readings[] = {
            {{near_motor}, truth.tension_N[near_motor] + noise(generator), {.additive_N = noise_N}},
            {{near_load}, truth.tension_N[near_load] + noise(generator), {.additive_N = noise_N}}};
        estimator.step({proximal_m, 0.0}, readings);

        const double error_N = estimator.mean_N()[20] - truth.tension_N[20];
        squared_N2 += error_N * error_N;
        held += std::abs(error_N) < 1.96 * estimator.deviation_N()[20] ? 1 : 0;
    }
    std::printf("node 20 of 40, without a sensor: RMS error %.3f N, within the 95%% band %d of %d times\n",
                std::sqrt(squared_N2 / samples), held, samples);
    return 0;
}
