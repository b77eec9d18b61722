#include <fmt/format.h>

#include "capstan/answers/recording_answers.h"
#include "capstan/bench_model/calibration_numbers.h"
#include "capstan/bench_model/model_file.h"
#include "capstan/bench_model/model_prediction.h"
#include "capstan/calibration/calibration.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/duty/duty_cycle.h"
#include "capstan/platform/files.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::cli {

namespace {

ExitCode run_calibrate(const Invocation& invocation) {
    Recording recording = read_recording(invocation.argument("LOG"));
    if (invocation.has("runs"))
        recording = model_comparison::runs_of(recording, run_numbers(invocation.text("runs")));
    gap::CalibrationOptions options;
    options.threads = invocation.count("jobs");
    options.segments = invocation.count("segments");
    if (invocation.has("fit")) options.fitted = split_at_commas(invocation.text("fit"));
    std::optional<bench_model::BenchModel> model;
    if (invocation.has("model")) {
        model = bench_model::read_model(invocation.text("model"));
        bench_model::recording_of_bench(*model, recording);  // throws where it is of another bench
        for (const gap::FittedNumber& number : calibration_numbers(*model))
            options.start[number.name] = number.value;
    }
    ShownWork work(invocation, recording.name);
    const gap::Calibration calibration = gap::calibrate(recording, options);
    work.end();
    reports::Answer answer = answers::calibration_answer(recording, calibration);
    if (model) answers::add_model_of_calibration(answer, *model);
    if (invocation.has("save")) write_file(invocation.text("save"), reports::answer_json(answer));
    deliver_answer(invocation, answer);
    return ExitCode::success;
}

}  // namespace

Command calibrate_command() {
    return {
        .name = "calibrate",
        .summary = "Fit friction, stiffness and pretension to a recording.",
        .description =
            "Drives the bench's model with the recording's driven channels and fits the model's "
            "parameters to all other channels at once. Prints each parameter with a 95% interval. A "
            "parameter that the recording does not determine is reported as such, with the parameter "
            "that it trades off against. Also prints how well the model reproduces each channel of each "
            "run: with the nominal parameters, with the fitted ones, and with parameters fitted to the "
            "other runs only. Where the geometry is unknown (mode lumped_drive), the model is a "
            "pull-pull pair with all wrap in one friction exponent.",
        .arguments = {log_argument},
        .options =
            {Option{.name = "fit",
                    .value = "NAMES",
                    .meaning = "Fit only these parameters, separated by commas; the others stay nominal."},
             Option{.name = "runs", .value = "LIST", .meaning = "Fit to these runs only, for example 1,3."},
             Option{
                 .name = "model",
                 .value = "FILE",
                 .meaning =
                     "Start from the numbers of a model that `capstan diagnose --save` wrote, and print them beside "
                     "the fitted ones."},
             segments_option,
             Option{.name = "save",
                    .value = "FILE",
                    .meaning =
                        "Also write the parameters to FILE, for `capstan simulate LOG --parameters FILE`.",
                    .check = check_writable},
             jobs_option, answer_output_option, json_option, progress_option, help_option},
        .examples = {"capstan calibrate bench.csv",
                     "capstan calibrate bench.csv --fit dynamic_friction,pretension --json",
                     "capstan calibrate later.csv --runs 1,3 --model model.toml"},
        .run = run_calibrate,
        .time =
            "Seconds to a minute, in proportion to the length of the recording and to the square of its runs. Shows progress and "
            "the time left."};
}

namespace {

ExitCode run_duty(const Invocation& invocation) {
    const Recording recording = read_recording(invocation.argument("LOG"));
    duty::DutyOptions options;
    options.jobs = invocation.count("jobs");
    options.segments = invocation.count("segments");
    options.still_m_per_s = 1e-3 * invocation.number("still");
    invocation.take("parameters", options.parameters);
    ShownWork work(invocation, recording.name);
    const duty::DutyCycle duty = duty::measure_duty(recording, options);
    work.end();
    deliver_answer(invocation, answers::duty_answer(recording, duty));
    return ExitCode::success;
}

}  // namespace

Command duty_command() {
    return {.name = "duty",
            .summary = "Measure from a recording how often each motion regime occurs.",
            .description =
                "Drives the bench's model with the recording's driven channels and counts at each sample "
                "which nodes of each cable slide: all nodes (mass), nodes at the proximal end, at the distal "
                "end, at both ends, or none. Slack cables are counted separately. The fractions of the "
                "moving time are the duty cycle over which `capstan place` and `capstan recommend` average.",
            .arguments = {log_argument},
            .options =
                {{.name = "still",
                  .kind = OptionKind::number,
                  .value = "MM/S",
                  .meaning = "A cable is at rest while both its ends move slower than this.",
                  .default_value = "0.2",
                  .limits = {0, 1e6}},
                 {.name = "parameters",
                  .value = "FILE",
                  .meaning =
                      "Friction, stiffness and pretension, in a file written by `capstan calibrate --save`."},
                 segments_option,
                 jobs_option,
                 answer_output_option,
                 json_option,
                 progress_option,
                 help_option},
            .examples = {"capstan duty bench.csv",
                         "capstan duty bench.csv --parameters fitted.json --json -o duty.json"},
            .run = run_duty,
            .time = "As long as the recording, divided by about 1000. Shows progress and the time left."};
}

}  // namespace capstan::cli
