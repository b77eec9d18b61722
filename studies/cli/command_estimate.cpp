#include <fmt/format.h>

#include "capstan/answers/placement_answers.h"
#include "capstan/answers/recording_answers.h"
#include "capstan/bench_model/model_file.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/config/config_reader.h"
#include "capstan/estimate/cycle_trial.h"
#include "capstan/estimate/estimated_series.h"
#include "capstan/estimate/modelled_cable.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/recording/recording_reader.h"

namespace capstan::cli {

namespace {

using estimate::SensedCable;

std::vector<std::size_t> named_channels(const SensedCable& cable, const std::string& wanted) {
    std::vector<std::size_t> found;
    for (std::size_t channel = 0; channel < cable.channels.size(); ++channel) {
        if (wanted == "each" || wanted == cable.channels[channel].name) found.push_back(channel);
    }
    return found;
}

std::vector<answers::LeftOutCable> left_out_cables(const std::vector<SensedCable>& cables,
                                                   const std::string& wanted,
                                                   const estimate::TrackingOptions& options) {
    std::vector<answers::LeftOutCable> results;
    std::string known;
    for (const SensedCable& cable : cables) {
        const std::vector<std::size_t> channels = named_channels(cable, wanted);
        if (!channels.empty()) results.push_back({&cable, leave_out(cable, channels, options)});
        for (const auto& channel : cable.channels) known += (known.empty() ? "" : ", ") + channel.name;
    }
    if (results.empty()) {
        throw UsageError(fmt::format(
            "capstan estimate: no channel \"{}\" measures a tension in this recording; these channels "
            "do: {}; or write `each`",
            wanted, known));
    }
    return results;
}

ExitCode score_layouts(const Invocation& invocation) {
    if (invocation.has("leave-out"))
        throw UsageError(
            "capstan estimate: --leave-out is for recordings; CONFIG is a study, whose layouts are scored");
    if (invocation.has("model"))
        throw UsageError("capstan estimate: --model is for recordings; a study states its cable in CONFIG");
    StudyPlan plan = config::read_config(invocation.argument("LOG")).plan;
    invocation.take("seed", plan.seed);
    estimate::CycleOptions options;
    options.members = invocation.count("members");
    options.jobs = invocation.count("jobs");
    invocation.take("repetitions", options.repetitions);
    ShownWork work(invocation, plan.name);
    const auto scores = score_cycles(plan, options);
    work.end();
    deliver_answer(invocation, answers::cycle_answer(plan, scores, options.repetitions));
    return ExitCode::success;
}

void expect_work_of(const Invocation& invocation, const std::vector<SensedCable>& cables,
                    const estimate::TrackingOptions& options) {
    for (const SensedCable& cable : cables) {
        const double once = estimate::tracking_work(cable, options);
        if (invocation.has("leave-out")) {
            const std::size_t channels = named_channels(cable, invocation.text("leave-out")).size();
            expect_work(estimate::leave_out_work(cable, channels, options) +
                        (invocation.has("html") ? static_cast<double>(channels) * once : 0.0));
        } else {
            expect_work(estimate::tuning_work(cable, options) + (invocation.has("html") ? once : 0.0) +
                        (invocation.has("json") ? 0.0 : once));
        }
    }
}

ExitCode run_estimate(const Invocation& invocation) {
    if (!names_a_recording(invocation.argument("LOG"))) return score_layouts(invocation);
    const Recording recording = read_recording(invocation.argument("LOG"));
    const int segments = invocation.count("segments");
    std::optional<bench_model::BenchModel> model;
    if (invocation.has("model")) model = bench_model::read_model(invocation.text("model"));
    const estimate::ModelledCables modelled =
        model ? estimate::modelled_cables(recording, *model, segments)
              : estimate::ModelledCables{estimate::sensed_cables(recording, segments), {}};
    const std::vector<SensedCable>& cables = modelled.cables;
    estimate::TrackingOptions options;
    options.members = invocation.count("members");
    invocation.take("seed", options.seed);
    options.jobs = invocation.count("jobs");
    const auto figures = invocation.has("html") ? answers::Figures::drawn : answers::Figures::none;
    ShownWork work(invocation, recording.name);
    expect_work_of(invocation, cables, options);
    if (invocation.has("leave-out")) {
        const auto results = left_out_cables(cables, invocation.text("leave-out"), options);
        reports::Answer answer = answers::left_out_answer(recording, results, options, figures);
        work.end();
        if (model) answers::add_model_of_estimate(answer, *model, modelled.not_used);
        deliver_answer(invocation, answer);
        return ExitCode::success;
    }
    std::vector<estimate::EstimatorTuning> tuned;
    for (const SensedCable& cable : cables) tuned.push_back(tune_estimator(cable, options));
    reports::Answer answer = answers::estimate_answer(recording, cables, tuned, options, figures);
    if (model) answers::add_model_of_estimate(answer, *model, modelled.not_used);
    deliver_page(invocation, answer);
    if (invocation.has("json")) {
        work.end();
        deliver(invocation, reports::answer_json(answer));
        return ExitCode::success;
    }
    const std::filesystem::path file = invocation.text("output");
    if (!exports::is_series_file(file) && model) say(answers::model_use_sentence(*model, modelled.not_used));
    const std::vector<exports::Series> series = estimate::estimated_series(cables, tuned, options);
    work.end();
    if (exports::is_series_file(file))
        exports::write_series(file, series);
    else
        deliver(invocation, estimate::estimated_csv(cables, series));
    return ExitCode::success;
}

const Option leave_out_option{
    .name = "leave-out",
    .value = "CHANNEL",
    .meaning =
        "Predict this channel from all others and compare the prediction with its readings; `each` "
        "does this for every channel in turn."};

const Option estimate_model_option{
    .name = "model",
    .value = "FILE",
    .meaning =
        "Take friction (also viscous and Stribeck), stiffness, pretension, bends and zeros, with their intervals, "
        "from a model that `capstan diagnose --save` wrote."};

const Option cut_option{.name = "segments",
                        .kind = OptionKind::integer,
                        .value = "N",
                        .meaning = "Segments per cable.",
                        .default_value = "40",
                        .limits = {2, 1000}};

const Option members_option{
    .name = "members",
    .kind = OptionKind::integer,
    .value = "N",
    .meaning = "Number of ensemble members that represent the possible states of the cable; a power of two.",
    .default_value = "32",
    .limits = {8, 1024}};

}  // namespace

Command estimate_command() {
    return {
        .name = "estimate",
        .summary = "Estimate the tension everywhere over time from a recording's few sensors.",
        .description =
            "Runs the recursive estimator over each run of a recording: the measured angles drive the "
            "model from the previous estimate, and every channel that measures a tension corrects it. "
            "Writes CSV: the tension at every node of every cable that carries a sensor, and the "
            "half-width of its 95% band; as MATLAB file or MCAP where -o ends in .mat or .mcap. The trust in the model is chosen by the likelihood of the "
            "readings; the band is widened by the errors of predicting each channel from the others. "
            "With --leave-out, predicts the named channels from all others and prints the error, the "
            "channel's noise, how often the reading was within the 95% band, and the errors of the model "
            "alone and of the paper's estimators, started from their own estimates, on the same samples. "
            "With --model, the cables are those of a model that a diagnosis saved; what its intervals leave open widens the band. "
            "With a study's configuration: simulates its complete motion and scores each of its layouts "
            "by the mean error of this estimator and of the paper's estimators over the motion "
            "(--repetitions draws of noise, 20 by default).",
        .arguments = {Argument{
            "LOG", "A recording (NAME.csv with NAME.json beside it), or a study's configuration (TOML)."}},
        .options = {leave_out_option, estimate_model_option, cut_option, members_option, repetitions_option,
                    seed_option, jobs_option, output_option, json_option, page_option, progress_option,
                    help_option},
        .examples = {"capstan estimate bench.csv -o tensions.csv --html tensions.html",
                     "capstan estimate bench.csv -o tensions.mat",
                     "capstan estimate bench.csv --leave-out each",
                     "capstan estimate bench.csv --leave-out tension_2 --json",
                     "capstan estimate bench.csv --leave-out each --model model.toml",
                     "capstan estimate configs/paper.toml"},
        .run = run_estimate,
        .time =
            "A minute of recording at 100 Hz takes about 1 s for each cable, that times the number of sensors with --leave-out each; "
            "a study's configuration takes 15 s. Shows progress and the time left."};
}

}  // namespace capstan::cli
