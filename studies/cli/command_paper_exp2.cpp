#include <fmt/format.h>

#include <iterator>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/output.h"
#include "capstan/cli/paper_experiment.h"
#include "capstan/cli/paper_pages.h"
#include "capstan/cli/viscous_answer.h"
#include "capstan/cli/viscous_recording.h"
#include "capstan/paper/error_reduction_tunnel.h"
#include "capstan/platform/wrapped_text.h"

namespace capstan::cli {

namespace {

using nlohmann::ordered_json;
using paper::CableSetting;
using paper::TunnelRun;

constexpr paper::PaperTunnel papers_numbers;

std::string row(const TunnelRun& run) {
    return fmt::format("  {:>8.1f}  {:>9.3f}  {:>9.3f}  {:>12.3f}  {:>12.1f}  {:>9.2f}  {:>10.2f}  {:>8}\n",
                       run.pretension_N, run.peak_load_torque_Nm, run.ideal_peak_load_torque_Nm,
                       run.rms_to_ideal_Nm, 1e2 * run.rms_to_ideal_Nm / run.peak_load_torque_Nm,
                       run.loop_work_J, run.dissipated_J, run.unsolved_steps);
}

const std::string head =
    "  T0 [N]         peak      ideal  rms to ideal   rms by peak  loop area   friction     steps\n"
    "                [N m]      [N m]         [N m]           [%]        [J]   loss [J]  unsolved\n";

std::string in_words(const std::vector<std::vector<TunnelRun>>& runs) {
    std::string text =
        "Exp. 2: the handle moves 40 deg peak to peak, the motor torque follows the error-reduction tunnel (7).\n\n";
    for (std::size_t s = 0; s < runs.size(); ++s) {
        const CableSetting& setting = paper::cable_settings()[s];
        text += wrapped(setting.name + ": " + setting.meaning, 100, "", "  ") + "\n\n" + head;
        for (const TunnelRun& run : runs[s]) text += row(run);
        text += "\n";
    }
    text += fmt::format("Paper (bench): peak {:.2f} N m, rms to ideal {:.3f} N m, {:.1f}% of the peak.\n",
                        papers_numbers.implied_peak_Nm(), papers_numbers.rms_to_ideal_Nm,
                        1e2 * papers_numbers.rms_to_ideal_by_peak);
    return text +
           wrapped(fmt::format(
                       "Loop area and friction loss are of one period of the motion ({:.0f} s); the "
                       "ideal transmission has neither. Unsolved: at a reversal the motor torque can jump by "
                       "the friction of one segment, and a torque inside the jump is met only to "
                       "that. Without viscous friction, which follows.",
                       paper::handle_period_s),
                   100, "", "") +
           "\n\n";
}

ordered_json in_json(const std::vector<std::vector<TunnelRun>>& runs,
                     const paper::ViscousComparison& viscous) {
    ordered_json json = {{"experiment", "exp2"},
                         {"paper",
                          {{"implied_peak_load_torque_Nm", papers_numbers.implied_peak_Nm()},
                           {"rms_to_ideal_Nm", papers_numbers.rms_to_ideal_Nm},
                           {"rms_to_ideal_by_peak", papers_numbers.rms_to_ideal_by_peak}}},
                         {"runs", ordered_json::array()}};
    for (const auto& setting : runs) {
        for (const TunnelRun& run : setting) {
            json["runs"].push_back({{"setting", run.setting},
                                    {"pretension_N", run.pretension_N},
                                    {"peak_load_torque_Nm", run.peak_load_torque_Nm},
                                    {"ideal_peak_load_torque_Nm", run.ideal_peak_load_torque_Nm},
                                    {"rms_to_ideal_Nm", run.rms_to_ideal_Nm},
                                    {"loop_work_J", run.loop_work_J},
                                    {"dissipated_J", run.dissipated_J},
                                    {"unsolved_steps", run.unsolved_steps}});
        }
    }
    json["viscous_friction"] = viscous_in_json(viscous);
    return json;
}

std::string in_csv(const std::vector<std::vector<TunnelRun>>& runs) {
    std::string text =
        "setting,pretension_N,time_s,load_angle_rad,motor_torque_Nm,motor_angle_rad,load_torque_Nm,"
        "ideal_load_torque_Nm\n";
    for (const auto& setting : runs) {
        for (const TunnelRun& run : setting) {
            for (const paper::TunnelSample& sample : run.samples) {
                fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{}\n", run.setting,
                               run.pretension_N, sample.time_s, sample.load_angle_rad, sample.motor_torque_Nm,
                               sample.motor_angle_rad, sample.load_torque_Nm, sample.ideal_load_torque_Nm);
            }
        }
    }
    return text;
}

ExitCode run(const Invocation& invocation) {
    const auto runs = run_every_setting([](const CableSetting& setting, double pretension_N) {
        return paper::run_error_reduction_tunnel(setting, pretension_N, {});
    });
    const CableSetting& setting = paper::cable_settings().back();
    paper::ViscousBench bench;
    bench.drag_N_s_per_m2 = invocation.real("viscous-drag");
    const double part = invocation.real("remainder");
    bench.remainder *= part;
    bench.load_friction_Nm *= part;
    const auto viscous = paper::compare_viscous_models(setting, setting.pretensions_N.back(), bench, {});
    if (invocation.has("recording")) write_viscous_recording(invocation.text("recording"), setting, viscous);
    deliver_page(invocation, [&] { return reports::experiment_page_html(exp2_page(runs, viscous)); });
    return deliver_experiment(invocation, in_csv(runs),
                              invocation.has("json") ? json_text(in_json(runs, viscous))
                                                     : in_words(runs) + viscous_in_words(viscous));
}

const Option viscous_drag_option{
    "viscous-drag",
    '\0',
    OptionKind::real_number,
    "DRAG",
    "Viscous friction of the simulated bench, N s/m2 of conduit. The default leaves the model without it the paper's "
    "residual of 264 mN m.",
    "4",
    {},
    0.1,
    100};

const Option remainder_option{
    "remainder",
    '\0',
    OptionKind::real_number,
    "PART",
    "What the simulated bench of Fig. 6 has beyond viscous friction, in parts of what leaves half of the residual: 0 is "
    "nothing.",
    "1",
    {},
    0.0,
    10.0};

const Option recording_option{
    "recording", '\0', OptionKind::text, "FILE",
    "Also write the simulated bench of Fig. 6 as a recording, FILE.csv with its sidecar, for capstan diagnose."};

}  // namespace

Command paper_exp2_command() {
    return {
        "paper exp2",
        "Repeat the paper's Exp. 2: an error-reduction tunnel under a moving hand.",
        "Simulates the pull-pull bench of the paper's Exp. 2 with our model: a hand moves the handle about 40 deg "
        "peak to peak (three sines; the paper does not print its participant's motion), and the motor torque follows "
        "from the load angle by the paper's (7), a spring outside +-0.05 rad that ends at 0.2 N m. Prints peak load "
        "torque and the loop that friction makes of the tunnel, beside the ideal transmission and the paper's "
        "numbers. Both cable settings of `capstan paper exp1`, 100 segments to a cable, 5 ms to a step. Then the paper's "
        "Fig. 6: what a viscous friction term takes of the residual, on a bench that is simulated too, with viscous "
        "friction, noise and a remainder that no model has.",
        {},
        {viscous_drag_option, remainder_option, recording_option, trajectories_option, page_option,
         json_option, help_option},
        {"capstan paper exp2", "capstan paper exp2 --html exp2.html",
         "capstan paper exp2 --json -o tunnel.csv", "capstan paper exp2 --recording fig6.csv"},
        run};
}

}  // namespace capstan::cli
