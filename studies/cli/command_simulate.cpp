#include <fmt/format.h>

#include <iterator>

#include "capstan/answers/paper_answers.h"
#include "capstan/answers/recording_answers.h"
#include "capstan/bench/bench_run.h"
#include "capstan/cable/motion_name.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/config/config_file.h"
#include "capstan/config/config_reader.h"
#include "capstan/gap/parameter_file.h"
#include "capstan/gap/twin.h"
#include "capstan/plan/true_motion.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::cli {

namespace {

using bench::BenchInstant;

std::string bench_head_line(int nodes, bool with_tensions) {
    std::string line =
        "time_s,motor_torque_Nm,motor_angle_rad,load_torque_Nm,load_angle_rad,solved,min_tension_a_N,"
        "min_tension_b_N";
    for (const char cable : {'a', 'b'}) {
        for (int node = 1; with_tensions && node <= nodes; ++node)
            line += fmt::format(",tension_{}_{}_N", cable, node);
    }
    return line + "\n";
}

double smallest(const std::vector<double>& tension_N) {
    return *std::min_element(tension_N.begin(), tension_N.end());
}

void append_instant(std::string& text, const BenchInstant& now, bool with_tensions) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{},{},{},{},{},{},{},{}", now.time_s, now.motor_torque_Nm, now.motor_angle_rad,
                   now.load_torque_Nm, now.load_angle_rad, now.solved ? 1 : 0, smallest(now.tension_a_N),
                   smallest(now.tension_b_N));
    for (const auto* cable : {&now.tension_a_N, &now.tension_b_N}) {
        for (std::size_t node = 0; with_tensions && node < cable->size(); ++node)
            fmt::format_to(out, ",{}", (*cable)[node]);
    }
    text += "\n";
}

ExitCode simulate_bench_file(const Invocation& invocation) {
    const bench::BenchPlan plan = config::read_bench(invocation.argument("CONFIG")).plan;
    const bool with_tensions = invocation.has("tensions");
    std::string text = bench_head_line(plan.cable.segments + 1, with_tensions);
    answers::BenchAnswer page(plan);
    bench::simulate_bench(plan, [&](const BenchInstant& now) {
        append_instant(text, now, with_tensions);
        page.add(now);
    });
    deliver_page(invocation, page.finished());
    deliver(invocation, text);
    return ExitCode::success;
}

using gap::TwinRun;

// The inputs of a run and the model's prediction, channel by channel.
std::vector<std::vector<double>> fed_and_predicted(const Recording& recording, std::size_t run,
                                                   const TwinRun& twin) {
    DrivenInputs inputs = driven_inputs(recording, recording.runs[run]);
    std::vector<std::vector<double>> values = twin.values;
    for (std::size_t channel = 0; channel < recording.channels.size(); ++channel) {
        if (!inputs.values[channel].empty()) values[channel] = std::move(inputs.values[channel]);
    }
    return values;
}

std::string recording_head_line(const Recording& recording) {
    std::string line = "run,t";
    for (const Channel& channel : recording.channels) line += "," + channel.name;
    return line + "\n";
}

void append_run(std::string& text, const RecordedRun& run, const std::vector<std::vector<double>>& values) {
    auto out = std::back_inserter(text);
    for (std::size_t sample = 0; sample < run.time_s.size(); ++sample) {
        fmt::format_to(out, "{},{}", run.number, run.time_s[sample]);
        for (const std::vector<double>& channel : values) {
            if (channel.empty()) {
                fmt::format_to(out, ",");
            } else {
                fmt::format_to(out, ",{}", channel[sample]);
            }
        }
        text += "\n";
    }
}

ExitCode simulate_recording(const Invocation& invocation) {
    const Recording recording = read_recording(invocation.argument("CONFIG"));
    const auto twin = gap::make_twin(recording, static_cast<int>(invocation.integer("segments")));
    std::vector<double> values = gap::nominal_values(*twin);
    if (invocation.has("parameters"))
        values = gap::read_parameter_values(invocation.text("parameters"), twin->parameters());
    std::string text = recording_head_line(recording);
    std::vector<TwinRun> modelled;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        modelled.push_back(twin->run(run, values));
        append_run(text, recording.runs[run], fed_and_predicted(recording, run, modelled.back()));
    }
    deliver_page(invocation, answers::recording_answer(recording, modelled));
    deliver(invocation, text);
    return ExitCode::success;
}

std::string head_line(int nodes) {
    std::string line =
        "sample,time_s,motion,regime,proximal_moving_nodes,distal_moving_nodes,proximal_direction,distal_direction,"
        "verified";
    for (int node = 1; node <= nodes; ++node) line += fmt::format(",tension_{}_N", node);
    for (int node = 1; node <= nodes; ++node) line += fmt::format(",displacement_{}_m", node);
    return line + "\n";
}

void append_line(std::string& text, const TrueSample& sample, double sample_rate_Hz) {
    const MotionPattern& pattern = sample.report.pattern;
    const auto regime = regime_of(pattern);
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{},{},{},{},{},{},{},{},{}", sample.sample, sample.sample / sample_rate_Hz,
                   name_of(pattern.kind), regime ? name_of(*regime) : "", pattern.proximal_moving_nodes,
                   pattern.distal_moving_nodes, sign(pattern.proximal_direction),
                   sign(pattern.distal_direction), sample.report.verified ? 1 : 0);
    for (const double tension_N : sample.now.tension_N) fmt::format_to(out, ",{}", tension_N);
    for (const double displacement_m : sample.now.displacement_m) fmt::format_to(out, ",{}", displacement_m);
    text += "\n";
}

ExitCode run_simulate(const Invocation& invocation) {
    if (names_a_recording(invocation.argument("CONFIG"))) return simulate_recording(invocation);
    if (config::content_of_config(invocation.argument("CONFIG")) == config::ConfigContent::bench)
        return simulate_bench_file(invocation);
    if (invocation.has("html")) {
        throw UsageError(
            "capstan simulate: a study's motion has no page; --html is for benches and recordings. `capstan study run` "
            "and `capstan report` make the page of a study");
    }
    const StudyPlan plan = config::read_config(invocation.argument("CONFIG")).plan;
    const QuasiStaticStep step(Cable(plan.transmission.cable), plan.transmission.rules);
    const CableState start = pretensioned(step.cable());
    std::string text = head_line(step.cable().nodes());
    const StepReport at_rest{};
    append_line(text, {0, start, start, at_rest}, plan.motion.sample_rate_Hz);
    simulate(step, plan.motion,
             [&](const TrueSample& sample) { append_line(text, sample, plan.motion.sample_rate_Hz); });
    deliver(invocation, text);
    return ExitCode::success;
}

const Option parameters_option{
    .name = "parameters",
    .value = "FILE",
    .meaning = "Recordings only: the model's parameters, in a file written by `capstan calibrate --save`."};

const Option tensions_option{.name = "tensions",
                             .kind = OptionKind::flag,
                             .meaning = "Benches only: also write the tension at every node of both cables."};

}  // namespace

Command simulate_command() {
    return {
        .name = "simulate",
        .summary = "Simulate a study's motion, a bench, or a recording's model, as CSV.",
        .description =
            "With a study's configuration: simulates its motion and writes one line per sample: time, "
            "kind of motion, motion regime, how many nodes move from each end (the last-moving nodes k "
            "and k' of the paper, each counted from its own end) and in which direction (1 towards the "
            "load, -1 towards the motor), whether the pattern passed the model's own check, and tension "
            "and displacement of every node. Use it to find instants for [[regime]]. With a bench's "
            "configuration (`capstan config default --bench`): simulates two cables between pulleys and "
            "writes time, torque and angle of motor and load, whether the step was solved, and the "
            "minimum tension in each cable (0: slack); --html plots them with the tension along the "
            "cables. With a recording (NAME.csv and NAME.json): drives the bench's model with the "
            "recording's driven channels and writes, in the format of the recording, the inputs (with "
            "the noise removed) and the model's prediction of the other channels; --html plots the "
            "prediction over the measurement.",
        .arguments = {Argument{"CONFIG",
                               "A study or a bench (TOML), or a recording (CSV with its JSON sidecar)."}},
        .options = {parameters_option, segments_option, tensions_option, output_option, page_option,
                    help_option},
        .examples = {"capstan simulate configs/paper.toml -o motion.csv",
                     "capstan simulate my.toml | awk -F, '$4 == \"mass\" {print $1}'",
                     "capstan simulate configs/bench-slack.toml --html slack.html -o slack.csv",
                     "capstan simulate bench.csv --parameters fitted.json -o model.csv --html model.html"},
        .run = run_simulate};
}

}  // namespace capstan::cli
