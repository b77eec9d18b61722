#include <fmt/format.h>

#include "capstan/answers/paper_answers.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/config/plan_checks.h"
#include "capstan/recording/recording_writer.h"

namespace capstan::cli {

namespace {

// Where an experiment's trajectories go; see deliver_experiment.
const Option trajectories_option = {
    .name = "output",
    .letter = 'o',
    .value = "FILE",
    .meaning =
        "Also write the trajectories to FILE as CSV; - writes them to standard output instead of the "
        "table."};

// The trajectories as CSV to where the option says; then the answer on standard output, unless they went
// there.
ExitCode deliver_experiment(const Invocation& invocation, const std::string& trajectories_csv,
                            const reports::Answer& answer) {
    deliver_page(invocation, answer);
    if (invocation.has("output")) {
        if (invocation.text("output") == "-") {
            write_standard_output(trajectories_csv);
            return ExitCode::success;
        }
        write_file(invocation.text("output"), trajectories_csv);
    }
    write_standard_output(invocation.has("json") ? reports::answer_json(answer)
                                                 : reports::answer_text(answer));
    return ExitCode::success;
}

// `run(setting, pretension_N)` for each cable setting of the paper's bench: settings x pretensions.
template <typename Run>
auto run_every_setting(const Run& run) {
    using Result = decltype(run(paper::cable_settings().front(), 0.0));
    std::vector<std::vector<Result>> runs;
    for (const paper::CableSetting& setting : paper::cable_settings()) {
        runs.emplace_back();
        for (const double pretension_N : setting.pretensions_N)
            runs.back().push_back(run(setting, pretension_N));
    }
    return runs;
}

ExitCode run_paper_solver(const Invocation& invocation) {
    std::vector<answers::RatesOfCable> rates;
    const std::vector<int> all_segments{1, 2, 3, 5, 10, 20, 40, 60};
    ShownWork work(invocation, "paper solver");
    expect_work(static_cast<double>(all_segments.size()));
    for (const int segments : all_segments) {
        rates.push_back(
            {segments, paper::race({paper::ComparedMotion::partial, segments, invocation.number("seconds")},
                                   {paper::linear_assumed_peer(), paper::generic_peer()})});
        note_work();
    }
    const auto compared = paper::compare_with_generic_solver();
    work.end();
    deliver_answer(invocation, answers::solver_answer(compared, rates));
    return ExitCode::success;
}

}  // namespace

Command paper_solver_command() {
    return {.name = "paper solver",
            .summary = "Repeat the paper's comparison of solvers (Sec. III.B, Fig. 7).",
            .description =
                "Compares the closed-form step with a generic root finder on the same equations, step by "
                "step: the fraction of steps in which the root finder converges and the largest difference "
                "of tension, in mass, partial, mono- and bidirectional motion with 1 to 60 segments. Then "
                "prints steps per second against the number of segments, beside the paper's figures.",
            .options = {{.name = "seconds",
                         .kind = OptionKind::number,
                         .value = "S",
                         .meaning = "Time per solver and number of segments.",
                         .default_value = "0.1",
                         .limits = {0.01, 60}},
                        output_option,
                        page_option,
                        json_option,
                        progress_option,
                        help_option},
            .examples = {"capstan paper solver", "capstan paper solver --html solver.html",
                         "capstan paper solver --json -o solver.json"},
            .run = run_paper_solver,
            .time = "100 times --seconds, 10 s by default. Shows progress and the time left."};
}

namespace {

ExitCode run_paper_exp1(const Invocation& invocation) {
    const auto runs = run_every_setting([](const paper::CableSetting& setting, double pretension_N) {
        return paper::run_pretension_ramps(setting, pretension_N, {});
    });
    return deliver_experiment(invocation, answers::trajectories_csv(runs),
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
            .run = run_paper_exp1};
}

namespace {

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
    if (invocation.has("recording")) {
        const std::filesystem::path file = invocation.text("recording");
        Recording recording = paper::recorded_bench(setting, viscous);
        recording.name = file.stem().string();
        write_recording(file, recording);
    }
    return deliver_experiment(invocation, answers::trajectories_csv(runs),
                              answers::exp2_answer(runs, viscous));
}

const Option viscous_drag_option{
    .name = "viscous-drag",
    .kind = OptionKind::number,
    .value = "DRAG",
    .meaning =
        "Viscous friction of the simulated bench, in N s/m2 of conduit. With the default, the model "
        "without viscous friction leaves the paper's residual of 264 mN m.",
    .default_value = "4",
    .limits = {0.1, 100}};

const Option remainder_option{
    .name = "remainder",
    .kind = OptionKind::number,
    .value = "PART",
    .meaning =
        "Size of the simulated bench's effects beyond viscous friction (Fig. 6), relative to the "
        "size at which they cause half of the residual; 0 removes them.",
    .default_value = "1",
    .limits = {0.0, 10.0}};

const Option recording_option{
    .name = "recording",
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

namespace {

ExitCode run_paper_estimation(const Invocation& invocation) {
    const config::ReadConfig config = read_config_of(invocation);
    config::require_runnable(config);
    if (!config.plan.compare_with_paper)
        throw InvalidInput(
            {"compare_with_paper: the configuration does not repeat the paper's experiment; use "
             "configs/paper.toml or a variant of it with compare_with_paper = true"});
    RunOptions options;
    options.jobs = invocation.count("jobs");
    ShownWork work(invocation, config.plan.name);
    const auto ablations = paper::ablate_readings(config.plan, options);
    work.end();
    deliver_answer(invocation, answers::paper_estimation_answer(ablations));
    return ExitCode::success;
}

}  // namespace

Command paper_estimation_command() {
    return {
        .name = "paper estimation",
        .summary = "Change each reading of the paper's estimation experiment by itself.",
        .description =
            "Runs the paper's estimation experiment as CONFIG has it, and once more with each reading that the "
            "paper leaves open changed by itself: the order in which direction patterns are tried, the instants, "
            "where a single sensor sits, the weights, the stiffness, the rules of the model, the blocked end. Prints "
            "the paper's numbers beside ours with and without each change, so that a reason that the comparison "
            "gives can be checked. Nothing is stored.",
        .arguments = {config_argument},
        .options = {seed_option, repetitions_option, jobs_option, output_option, json_option, progress_option,
                    help_option},
        .examples = {"capstan paper estimation configs/paper.toml",
                     "capstan paper estimation configs/paper.toml --json -o ablations.json"},
        .run = run_paper_estimation,
        .time =
            "Some ten times as long as the study itself, about a minute. Shows progress and the time left."};
}

}  // namespace capstan::cli
