#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "capstan/answers/paper_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/paper_experiment.h"
#include "capstan/paper/viscous_tunnel.h"
#include "capstan/reports/plain_tables.h"

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

std::string trajectories_csv(const std::vector<std::vector<paper::TunnelRun>>& runs) {
    std::string text =
        reports::csv_head({"setting", "pretension_N", "time_s", "load_angle_rad", "motor_torque_Nm",
                           "motor_angle_rad", "load_torque_Nm", "ideal_load_torque_Nm"});
    for (const auto& setting : runs) {
        for (const paper::TunnelRun& run : setting) {
            for (const auto& sample : run.samples)
                text +=
                    reports::csv_line({run.setting, run.pretension_N, sample.time_s, sample.load_angle_rad,
                                       sample.motor_torque_Nm, sample.motor_angle_rad, sample.load_torque_Nm,
                                       sample.ideal_load_torque_Nm});
        }
    }
    return text;
}

ExitCode run_paper_exp2(const Invocation& invocation) {
    const auto runs = run_every_setting([](const paper::CableSetting& setting, double pretension_N) {
        return paper::run_error_reduction_tunnel(setting, pretension_N, {});
    });
    const paper::CableSetting& setting = paper::cable_settings().back();
    paper::ViscousBench bench;
    bench.drag_N_s_per_m2 = invocation.number("viscous-drag");
    const double part = invocation.number("remainder");
    bench.remainder *= part;
    bench.load_friction_Nm *= part;
    const auto viscous = paper::compare_viscous_models(setting, setting.pretensions_N.back(), bench, {});
    if (invocation.has("recording")) write_viscous_recording(invocation.text("recording"), setting, viscous);
    return deliver_experiment(invocation, trajectories_csv(runs), answers::exp2_answer(runs, viscous));
}

const Option viscous_drag_option{
    .name = "viscous-drag",
    .kind = OptionKind::number,
    .value = "DRAG",
    .meaning =
        "Viscous friction of the simulated bench, in N s/m2 of conduit. With the default, the model "
        "without viscous friction leaves the paper's residual of 264 mN m.",
    .default_value = "4",
    .low = 0.1,
    .high = 100};

const Option remainder_option{
    .name = "remainder",
    .kind = OptionKind::number,
    .value = "PART",
    .meaning =
        "Size of the simulated bench's effects beyond viscous friction (Fig. 6), relative to the "
        "size at which they cause half of the residual; 0 removes them.",
    .default_value = "1",
    .low = 0.0,
    .high = 10.0};

const Option recording_option{
    .name = "recording",
    .kind = OptionKind::string,
    .value = "FILE",
    .meaning =
        "Also write the simulated bench of Fig. 6 to FILE (CSV) as a recording with its sidecar, for "
        "`capstan diagnose`."};

}  // namespace

Command paper_exp2_command() {
    return {
        .name = "paper exp2",
        .summary = "Repeat the paper's Exp. 2: an error-reduction tunnel under a moving hand.",
        .description =
            "Simulates the pull-pull bench of the paper's Exp. 2 with our model. A hand moves the handle "
            "by about 40 deg peak to peak (three sines; the paper does not print its participant's "
            "motion). The motor torque follows from the load angle by the paper's (7), a spring outside "
            "+-0.05 rad that is limited to 0.2 N m. Prints the peak load torque and the hysteresis that "
            "friction adds to the tunnel, beside the ideal transmission and the paper's numbers. Both "
            "cable settings of `capstan paper exp1` are run, with 100 segments per cable and steps of 5 "
            "ms. Then repeats the paper's Fig. 6: how much of the residual a viscous friction term "
            "explains, on a simulated bench with viscous friction, noise and a remainder that no model "
            "contains.",
        .options = {viscous_drag_option, remainder_option, recording_option, trajectories_option, page_option,
                    json_option, help_option},
        .examples = {"capstan paper exp2", "capstan paper exp2 --html exp2.html",
                     "capstan paper exp2 --json -o tunnel.csv", "capstan paper exp2 --recording fig6.csv"},
        .run = run_paper_exp2};
}

}  // namespace capstan::cli
