#include <fmt/format.h>

#include <cstddef>
#include <iterator>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/output.h"
#include "capstan/cli/paper_experiment.h"
#include "capstan/cli/paper_pages.h"
#include "capstan/paper/pretension_ramps.h"
#include "capstan/platform/wrapped_text.h"

namespace capstan::cli {

namespace {

using nlohmann::ordered_json;
using paper::CableSetting;
using paper::PaperRamp;
using paper::RampRun;

// The paper's four levels belong to a setting of as many pretensions.
const PaperRamp* papers_level(const CableSetting& setting, std::size_t level) {
    const bool has_levels = setting.pretensions_N.size() == paper::papers_ramps().size();
    return has_levels ? &paper::papers_ramps()[level] : nullptr;
}

std::string row(const RampRun& run, const PaperRamp* paper) {
    return fmt::format("  {:>8.1f}  {:>7.1f} {:>7}  {:>10.1f}  {:>12.1f}  {:>7.1f} {:>7}  {:>8}\n",
                       run.pretension_N, 1e3 * run.peak_load_torque_Nm,
                       paper ? fmt::format("{:.0f}", 1e3 * paper->implied_peak_Nm()) : "",
                       1e3 * run.dead_width_Nm, 1e2 * run.lost_transfer_ratio, 1e3 * run.rms_to_ideal_Nm,
                       paper ? fmt::format("{:.0f}", 1e3 * paper->rms_to_ideal_Nm) : "", run.unsolved_steps);
}

const std::string head =
    "  T0 [N]      peak [mN m]     dead width  lost transfer    rms to ideal      steps\n"
    "               ours   paper      [mN m]           [%]     ours   paper  unsolved\n";

std::string in_words(const std::vector<std::vector<RampRun>>& runs) {
    std::string text =
        "Exp. 1: load locked, motor torque ramps of 0.1 N m/s between +-0.125 N m, 0.5 s dwell, 30 s.\n\n";
    for (std::size_t s = 0; s < runs.size(); ++s) {
        const CableSetting& setting = paper::cable_settings()[s];
        text += wrapped(setting.name + ": " + setting.meaning, 100, "", "  ") + "\n\n" + head;
        for (std::size_t k = 0; k < runs[s].size(); ++k) text += row(runs[s][k], papers_level(setting, k));
        text += "\n";
    }
    return text +
           wrapped(
               "Dead width: motor torque that a reversal goes through before the load torque changes (250 is "
               "the whole ramp). Lost transfer: 1 - peak / 650 mN m, the ideal transmission's. The paper's "
               "peaks follow from its rms errors and their fraction of the peak; its rms to the ideal is that "
               "of its bench, ours of the model.",
               100, "", "") +
           "\n";
}

ordered_json in_json(const std::vector<std::vector<RampRun>>& runs) {
    ordered_json json = {{"experiment", "exp1"}, {"runs", ordered_json::array()}};
    for (std::size_t s = 0; s < runs.size(); ++s) {
        for (std::size_t k = 0; k < runs[s].size(); ++k) {
            const RampRun& run = runs[s][k];
            ordered_json entry = {{"setting", run.setting},
                                  {"pretension_N", run.pretension_N},
                                  {"peak_load_torque_Nm", run.peak_load_torque_Nm},
                                  {"dead_width_Nm", run.dead_width_Nm},
                                  {"lost_transfer_ratio", run.lost_transfer_ratio},
                                  {"rms_to_ideal_Nm", run.rms_to_ideal_Nm},
                                  {"unsolved_steps", run.unsolved_steps}};
            if (const PaperRamp* paper = papers_level(paper::cable_settings()[s], k)) {
                entry["paper"] = {{"level", paper->level},
                                  {"implied_peak_load_torque_Nm", paper->implied_peak_Nm()},
                                  {"rms_to_ideal_Nm", paper->rms_to_ideal_Nm},
                                  {"rms_of_model_Nm", paper->rms_of_model_Nm},
                                  {"fraction_of_peak", paper->fraction_of_peak}};
            }
            json["runs"].push_back(entry);
        }
    }
    return json;
}

std::string in_csv(const std::vector<std::vector<RampRun>>& runs) {
    std::string text =
        "setting,pretension_N,time_s,motor_torque_Nm,motor_angle_rad,load_torque_Nm,ideal_load_torque_Nm\n";
    for (const auto& setting : runs) {
        for (const RampRun& run : setting) {
            for (const paper::RampSample& sample : run.samples) {
                fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{}\n", run.setting,
                               run.pretension_N, sample.time_s, sample.motor_torque_Nm,
                               sample.motor_angle_rad, sample.load_torque_Nm, sample.ideal_load_torque_Nm);
            }
        }
    }
    return text;
}

ExitCode run(const Invocation& invocation) {
    const auto runs = run_every_setting([](const CableSetting& setting, double pretension_N) {
        return paper::run_pretension_ramps(setting, pretension_N, {});
    });
    deliver_page(invocation, [&] { return reports::experiment_page_html(exp1_page(runs)); });
    return deliver_experiment(invocation, in_csv(runs),
                              invocation.has("json") ? json_text(in_json(runs)) : in_words(runs));
}

}  // namespace

Command paper_exp1_command() {
    return {
        "paper exp1",
        "Repeat the paper's Exp. 1: torque ramps against a locked load.",
        "Simulates the pull-pull bench of the paper's Exp. 1 with our model: the load is locked, the motor torque "
        "ramps up and down, the pretension varies. Prints peak load torque, dead width and lost torque transfer, the "
        "paper's numbers beside ours. Two cable settings are run, because Table I as it stands gives nothing at the "
        "load: table_1, and reproduces with less wrap and pretension. 100 segments to a cable and 5 ms to a step: "
        "the stiction rule depends on the length of a segment, and with fewer of them so would the numbers.",
        {},
        {trajectories_option, page_option, json_option, help_option},
        {"capstan paper exp1", "capstan paper exp1 --html exp1.html",
         "capstan paper exp1 --json -o ramps.csv"},
        run};
}

}  // namespace capstan::cli
