#include <fmt/format.h>

#include "capstan/answers/recording_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/duty/duty_cycle.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::cli {

namespace {

ExitCode run_duty(const Invocation& invocation) {
    const Recording recording = read_recording(invocation.argument("LOG"));
    duty::DutyOptions options;
    options.jobs = static_cast<int>(invocation.integer("jobs"));
    options.segments = static_cast<int>(invocation.integer("segments"));
    options.still_m_per_s = 1e-3 * invocation.number("still");
    if (invocation.has("parameters")) options.parameters = invocation.text("parameters");
    deliver_answer(invocation, answers::duty_answer(recording, duty::measure_duty(recording, options)));
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
                  .low = 0,
                  .high = 1e6},
                 {.name = "parameters",
                  .value = "FILE",
                  .meaning =
                      "Friction, stiffness and pretension, in a file written by `capstan calibrate --save`."},
                 segments_option,
                 jobs_option,
                 output_option,
                 json_option,
                 help_option},
            .examples = {"capstan duty bench.csv",
                         "capstan duty bench.csv --parameters fitted.json --json -o duty.json"},
            .run = run_duty};
}

}  // namespace capstan::cli
