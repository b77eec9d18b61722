#include "capstan/cli/viscous_recording.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "capstan/cli/output.h"

namespace capstan::cli {

namespace {

using reports::Data;

constexpr double motor_step_rad = 7.85e-4;  // an encoder of 8000 steps a turn

Data sidecar(const std::string& name, const paper::CableSetting& setting,
             const paper::ViscousComparison& comparison) {
    const PullPull pair = paper::paper_bench(setting, comparison.pretension_N, 1);
    const Cable& cable = pair.cable_a();
    const double step_s = comparison.samples[1].time_s - comparison.samples[0].time_s;
    return {{"case", name},
            {"schema", 1},
            {"mode", "pull_pull"},
            {"sample_rate_hz", 1.0 / step_s},
            {"units",
             {{"t", "s"},
              {"motor_torque", "N m"},
              {"motor_angle", "rad"},
              {"load_angle", "rad"},
              {"load_torque", "N m"}}},
            {"nominal",
             {{"L", cable.length_m()},
              {"R_profile",
               Data::list({Data{{"s0", 0.0}, {"s1", cable.length_m()}, {"R", setting.bend_radius_m}}})},
              {"r_input", pair.pulleys().motor_radius_m},
              {"r_load", pair.pulleys().load_radius_m},
              {"K", cable.axial_stiffness_N() / cable.length_m()},
              {"mu_d", cable.dynamic_friction()},
              {"mu_s", cable.static_friction()}}},
            {"noise_std", {{"load_torque", comparison.bench.torque_noise_Nm}}},
            {"encoder_step", {{"motor_angle", motor_step_rad}}},
            {"tension_sensors", Data::list()},
            {"runs", Data::list({Data{{"run", 1},
                                      {"protocol", "exp2"},
                                      {"t_session_start", 0.0},
                                      {"T0", comparison.pretension_N},
                                      {"output", "handle"},
                                      {"driven", Data::list({"motor_torque", "load_angle"})}}})}};
}

}  // namespace

void write_viscous_recording(const std::filesystem::path& csv, const paper::CableSetting& setting,
                             const paper::ViscousComparison& comparison) {
    std::string text = "run,t,motor_torque,motor_angle,load_angle,load_torque\n";
    for (const paper::ViscousSample& sample : comparison.samples)
        fmt::format_to(std::back_inserter(text), "1,{:.3f},{:.6f},{:.6f},{:.6f},{:.5f}\n", sample.time_s,
                       sample.motor_torque_Nm,
                       motor_step_rad * std::round(sample.bench_motor_angle_rad / motor_step_rad),
                       sample.load_angle_rad, sample.bench_torque_Nm);
    write_file(std::filesystem::path(csv).replace_extension(".json"),
               reports::json_text(sidecar(csv.stem().string(), setting, comparison)));
    write_file(csv, text);
}

}  // namespace capstan::cli
