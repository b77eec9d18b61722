// Scores two sensor layouts with every fusion method, as a study does, without a database.
#include <capstan/estimation/fusion_method.h>
#include <capstan/placement/fusion_stage.h>
#include <capstan/placement/single_sensor_stage.h>

#include <cstdio>

int main() {
    capstan::StudyPlan plan;
    plan.name = "two layouts";
    plan.repetitions = 200;
    plan.transmission.cable = {.curvature = {{.length_m = 0.4}, {.length_m = 0.314, .bend_radius_m = 0.2}},
                               .segments = 6,
                               .axial_stiffness_N = 2000.0,
                               .dynamic_friction = 0.2,
                               .static_friction = 0.3,
                               .pretension_N = 10.0};
    plan.motion.sample_rate_Hz = 100.0;
    plan.motion.samples = 100;
    plan.motion.proximal = {.amplitude = 0.003, .frequency_Hz = 1.0};
    plan.regimes = {{capstan::Regime::mass, {15}, 1.0}};
    plan.noise_levels = {{"5 %", {.multiplicative_ratio = 0.05}}};
    plan.explicit_layouts = {{0, 6}, {2, 4}};  // nodes from 0, at the motor
    for (const capstan::FusionMethod& method : capstan::fusion_methods())
        plan.fusion_methods.emplace_back(method.name);
    plan.largest_distal_increment_m = 2e-4;

    const capstan::PreparedStudy study = capstan::prepare(plan);
    const capstan::StudyPoint instant{.scenario_index = 0, .noise_index = 0};
    const int threads = 0;  // all
    double processor_time_s = 0.0;
    const auto readings = capstan::solve_readings(study, instant, threads, processor_time_s);
    const auto errors_N =
        capstan::sensor_errors_N(capstan::summarise_sensors(study, instant, readings, threads));
    capstan::FusionTimes times;
    const auto result = capstan::fuse_readings(study, instant, readings,
                                               capstan::sensor_weights(study, {errors_N}, 0), threads, times);
    for (const auto& cell : result.cells) {
        const auto& nodes = study.sensor_sets[cell.set_index];
        std::printf("sensors at nodes %d and %d, %-18s %.3f N (%.3f to %.3f)\n", nodes[0] + 1, nodes[1] + 1,
                    cell.method.c_str(), cell.mean_abs_error_N, cell.interval_low_N, cell.interval_high_N);
    }
}
