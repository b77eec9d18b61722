// Steps a cable: the motor end moves to and fro, the far end is held by a spring to a wall.
#include <capstan/solver/quasi_static_step.h>

#include <cmath>
#include <cstdio>

int main() {
    const capstan::Cable cable({
        .curvature = {{.length_m = 0.5}, {.length_m = 0.6, .bend_radius_m = 0.2}, {.length_m = 0.4}},
        .segments = 40,
        .axial_stiffness_N = 2000.0,
        .dynamic_friction = 0.15,
        .static_friction = 0.2,
        .pretension_N = 20.0,
    });
    const capstan::QuasiStaticStep model(cable, capstan::ModelRules::consistent());
    capstan::CableState state = capstan::pretensioned(cable);
    const double start_m = state.displacement_m.front();
    const auto wall = capstan::distal_spring({.stiffness_N_per_m = 400.0, .tension_N = 20.0});

    std::printf("time_s,proximal_displacement_m,proximal_tension_N,distal_tension_N\n");
    for (int sample = 1; sample <= 100; ++sample) {
        const double time_s = sample / 100.0;
        const double pulled_m = -0.02 * std::sin(2.0 * M_PI * time_s);  // towards the motor is negative
        const auto report =
            model.advance(state, {capstan::EndCondition::position_m(start_m + pulled_m), wall});
        if (!report.verified) return 1;
        if (sample % 10 == 0) {
            std::printf("%.2f,%.5f,%.3f,%.3f\n", time_s, pulled_m, state.tension_N.front(),
                        state.tension_N.back());
        }
    }
}
