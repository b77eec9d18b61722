#include "capstan/answers/paper_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/paper_experiment.h"
#include "capstan/reports/plain_tables.h"

namespace capstan::cli {

namespace {

std::string trajectories_csv(const std::vector<std::vector<paper::RampRun>>& runs) {
    std::string text = reports::csv_head({"setting", "pretension_N", "time_s", "motor_torque_Nm",
                                          "motor_angle_rad", "load_torque_Nm", "ideal_load_torque_Nm"});
    for (const auto& setting : runs) {
        for (const paper::RampRun& run : setting) {
            for (const auto& sample : run.samples)
                text += reports::csv_line({run.setting, run.pretension_N, sample.time_s,
                                           sample.motor_torque_Nm, sample.motor_angle_rad,
                                           sample.load_torque_Nm, sample.ideal_load_torque_Nm});
        }
    }
    return text;
}

ExitCode run(const Invocation& invocation) {
    const auto runs = run_every_setting([](const paper::CableSetting& setting, double pretension_N) {
        return paper::run_pretension_ramps(setting, pretension_N, {});
    });
    return deliver_experiment(invocation, trajectories_csv(runs),
                              answers::exp1_answer(runs, paper::compare_ramp_readings()));
}

}  // namespace

Command paper_exp1_command() {
    return {.name = "paper exp1",
            .summary = "Repeat the paper's Exp. 1: torque ramps against a locked load.",
            .description =
                "Simulates the pull-pull bench of the paper's Exp. 1 with our model: the load is locked, the "
                "motor torque ramps up and down, and the pretension varies. Prints peak load torque, dead "
                "width and lost torque transfer beside the paper's numbers. Two cable settings are run, "
                "because no torque reaches the load with Table I as printed: table_1, and reproduces with "
                "less wrap and pretension. Each cable has 100 segments and each step takes 5 ms: the "
                "stiction rule depends on the length of a segment, so fewer segments would change the "
                "numbers. The paper's rms errors of the ideal transmission do not follow from its "
                "printed torque; the last table tries other readings of it.",
            .options = {trajectories_option, page_option, json_option, help_option},
            .examples = {"capstan paper exp1", "capstan paper exp1 --html exp1.html",
                         "capstan paper exp1 --json -o ramps.csv"},
            .run = run};
}

}  // namespace capstan::cli
