#include <fmt/format.h>

#include <iterator>

#include "capstan/cable/motion_name.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/log_argument.h"
#include "capstan/cli/output.h"
#include "capstan/cli/simulated_bench.h"
#include "capstan/cli/simulated_recording.h"
#include "capstan/cli/usage_error.h"
#include "capstan/config/config_file.h"
#include "capstan/config/config_reader.h"
#include "capstan/plan/true_motion.h"

namespace capstan::cli {

namespace {

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

ExitCode run(const Invocation& invocation) {
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
    "parameters", '\0', OptionKind::text, "FILE",
    "Recordings only: the model's parameters, as `capstan calibrate --save` wrote them."};

const Option tensions_option{"tensions", '\0', OptionKind::flag, "",
                             "Benches only: also the tension of every node of both cables."};

}  // namespace

Command simulate_command() {
    return {
        "simulate",
        "Simulate a study's motion, a bench, or a recording's model, as CSV.",
        "With a study's configuration: simulates the motion that it describes and writes one line per sample: time, kind of "
        "motion, the study regime it belongs to, how many nodes move from each end (the last-moving nodes k and k' of "
        "the paper, each counted from its own end) and which way (1 towards the load, -1 towards the motor), whether "
        "the pattern passed the model's own check, tension and displacement of every node. Use it to find instants for "
        "[[regime]]. With a bench's configuration (`capstan config default --bench`): simulates two cables between pulleys "
        "and writes time, torque and angle of motor and load, whether the step was solved, and the least tension in "
        "each cable (0: slack); --html draws them, with the tension along the cables. With a recording (NAME.csv and NAME.json): moves the bench's model with the recording's driven "
        "channels and writes, in the recording's own form, what it was fed (freed of noise) and what it says that the "
        "other channels should have measured; --html draws that over what they did measure.",
        {Argument{"CONFIG", "A study or a bench (TOML), or a recording (CSV with its JSON sidecar)."}},
        {parameters_option, segments_option, tensions_option, output_option, page_option, help_option},
        {"capstan simulate configs/paper.toml -o motion.csv",
         "capstan simulate my.toml | awk -F, '$4 == \"mass\" {print $1}'",
         "capstan simulate configs/bench-slack.toml --html slack.html -o slack.csv",
         "capstan simulate bench.csv --parameters fitted.json -o model.csv --html model.html"},
        run};
}

}  // namespace capstan::cli
