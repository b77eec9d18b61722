#include <fmt/format.h>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/log_argument.h"
#include "capstan/cli/output.h"
#include "capstan/duty/duty_cycle.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::cli {

namespace {

using duty::DutyCycle;
using duty::MotionTimes;
using nlohmann::ordered_json;

std::string time_row(const std::string& name, const MotionTimes& times) {
    std::string row = fmt::format("  {:<10} {:>8.1f}", name, times.total_s());
    const auto fraction = [&](double time_s) {
        row += fmt::format("  {:>16}", fmt::format("{:.1f} %", 100.0 * time_s / times.total_s()));
    };
    for (const double time_s : times.regime_s) fraction(time_s);
    fraction(times.slack_s);
    fraction(times.still_s);
    return row + "\n";
}

std::string in_words(const Recording& recording, const DutyCycle& duty) {
    std::string text =
        fmt::format("{}: what its cables do\n\n  {:<10} {:>8}", recording.name, "run", "time [s]");
    for (const Regime regime : all_regimes) text += fmt::format("  {:>16}", name_of(regime));
    text += fmt::format("  {:>16}  {:>16}\n", "slack", "still");
    for (std::size_t k = 0; k < duty.runs.size(); ++k) {
        const RecordedRun& run = recording.runs[k];
        text += time_row(fmt::format("{}", run.number), duty.runs[k]);
    }
    text += time_row("all", duty.all);
    if (duty.unsolved_steps > 0)
        text += fmt::format("\n{} steps of the model did not verify.\n", duty.unsolved_steps);
    text +=
        "\nFraction of the time in which a cable moves, for [[regime]] of a study's configuration (fractions of the\n"
        "regimes that it has must sum to 1; `capstan place CONFIG --duty LOG` does that):\n\n";
    for (const Regime regime : all_regimes) {
        text += fmt::format("  name = \"{}\"\n  duty_fraction = {:.4f}\n", name_of(regime),
                            duty.fraction(regime));
    }
    return text;
}

ordered_json times_json(const MotionTimes& times) {
    ordered_json json = {
        {"total_s", times.total_s()}, {"still_s", times.still_s}, {"slack_s", times.slack_s}};
    for (const Regime regime : all_regimes) {
        json[std::string(name_of(regime)) + "_s"] = times.regime_s[static_cast<std::size_t>(regime)];
    }
    return json;
}

ordered_json in_json(const Recording& recording, const DutyCycle& duty) {
    ordered_json json = {{"case", recording.name}, {"unsolved_steps", duty.unsolved_steps}};
    for (const Regime regime : all_regimes)
        json["duty_fraction"][std::string(name_of(regime))] = duty.fraction(regime);
    json["all"] = times_json(duty.all);
    json["runs"] = ordered_json::array();
    for (std::size_t k = 0; k < duty.runs.size(); ++k) {
        ordered_json run = {{"run", recording.runs[k].number}};
        run.update(times_json(duty.runs[k]));
        json["runs"].push_back(std::move(run));
    }
    return json;
}

ExitCode run(const Invocation& invocation) {
    const Recording recording = read_recording(invocation.argument("LOG"));
    duty::DutyOptions options;
    options.jobs = static_cast<int>(invocation.whole("jobs"));
    options.segments = static_cast<int>(invocation.whole("segments"));
    options.still_m_per_s = 1e-3 * invocation.real("still");
    if (invocation.has("parameters")) options.parameters = invocation.text("parameters");
    const DutyCycle duty = duty::measure_duty(recording, options);
    deliver(invocation,
            invocation.has("json") ? json_text(in_json(recording, duty)) : in_words(recording, duty));
    return ExitCode::success;
}

}  // namespace

Command duty_command() {
    return {
        "duty",
        "Measure from a recording how often each motion regime occurs.",
        "Moves the bench's model with the recording's driven channels and counts, sample by sample, which nodes of each "
        "cable slide: all of them (mass), those at the proximal end, the distal end, or both, none, or a slack cable. "
        "The fractions of the moving time are the duty cycle over which `capstan place` and `capstan recommend` average.",
        {log_argument},
        {{"still",
          '\0',
          OptionKind::real_number,
          "MM/S",
          "A cable whose ends both move slower stands still.",
          "0.2",
          {},
          0,
          1e6},
         {"parameters", '\0', OptionKind::text, "FILE",
          "Friction, stiffness and pretension as `capstan calibrate --save` wrote them."},
         segments_option,
         jobs_option,
         output_option,
         json_option,
         help_option},
        {"capstan duty bench.csv", "capstan duty bench.csv --parameters fitted.json --json -o duty.json"},
        run};
}

}  // namespace capstan::cli
