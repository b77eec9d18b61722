#include <fmt/format.h>

#include <optional>
#include <set>

#include "capstan/answers/paper_answers.h"
#include "capstan/answers/recording_answers.h"
#include "capstan/bench/bench_recording.h"
#include "capstan/bench_model/model_file.h"
#include "capstan/bench_model/prediction_csv.h"
#include "capstan/calibration/parameter_file.h"
#include "capstan/calibration/twin.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/config/config_file.h"
#include "capstan/config/config_reader.h"
#include "capstan/export/series.h"
#include "capstan/model_comparison/model_comparison.h"
#include "capstan/plan/true_motion.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/recording/recording_writer.h"

namespace capstan::cli {

namespace {

bench::Instruments instruments_of(const Invocation& invocation) {
    bench::Instruments instruments;
    invocation.take("sensors", instruments.tension_sensors);
    invocation.take("sensor-noise", instruments.noise_fraction);
    invocation.take("seed", instruments.seed);
    return instruments;
}

// The recording where --output says, or its samples on standard output.
void deliver_recording(const Invocation& invocation, Recording recording,
                       const bench::Instruments& instruments) {
    bench::add_noise(recording, instruments);
    if (invocation.has("kind") && *mode_named(invocation.text("kind")) == BenchMode::lumped_drive) {
        recording.mode = BenchMode::lumped_drive;  // what is known of the geometry is withheld
        recording.nominal.reset();
        for (RecordedRun& run : recording.runs) {
            run.driven = usual_driven_channels(recording.mode);
            run.output = OutputKind::unknown;
        }
    }
    const std::filesystem::path file = invocation.text("output");
    if (file == "-") return write_standard_output(samples_csv(recording));
    if (std::filesystem::exists(file) && !std::filesystem::is_regular_file(file))  // a device or a pipe
        return write_file(file, samples_csv(recording));
    if (exports::is_series_file(file)) return exports::write_series(file, exports::series_of(recording));
    if (file.extension() != ".csv") {
        throw UsageError(fmt::format(
            "capstan simulate: a recording is NAME.csv with NAME.json beside it, or NAME.mat or NAME.mcap for other "
            "programs; give -o a name with such an ending instead of {}",
            file.string()));
    }
    if (!recording.name.empty()) recording.name = file.stem().string();
    write_recording(file, recording);
}

ExitCode simulate_bench_files(const Invocation& invocation) {
    const bench::Instruments instruments = instruments_of(invocation);
    std::optional<Recording> recording;
    for (const std::string& file : invocation.repeated_argument()) {
        const bench::BenchPlan plan = config::read_bench(file).plan;
        if (!recording) recording = bench::empty_recording(plan, instruments);
        bench::begin_run(*recording, plan);
        const Cable cable(plan.cable);
        answers::BenchAnswer page(plan);
        int unsolved = 0;
        bench::simulate_bench(plan, [&](const bench::BenchInstant& now) {
            bench::record(*recording, cable, now);
            page.add(now);
            unsolved += now.solved ? 0 : 1;
        });
        if (unsolved > 0)
            say(fmt::format("{}: {} samples were not solved; their values are approximate.", file, unsolved));
        if (file == invocation.repeated_argument().front()) deliver_page(invocation, page.finished());
    }
    deliver_recording(invocation, std::move(*recording), instruments);
    return ExitCode::success;
}

using gap::TwinRun;

// What was fed to the model and what it predicts, without the channels that it knows nothing of.
Recording model_recording(const Recording& recording, const std::vector<TwinRun>& modelled) {
    std::vector<std::vector<std::vector<double>>> values;  // runs x channels x samples
    for (std::size_t run = 0; run < recording.runs.size(); ++run) {
        DrivenInputs inputs = driven_inputs(recording, recording.runs[run]);
        values.push_back(modelled[run].values);
        for (std::size_t channel = 0; channel < recording.channels.size(); ++channel)
            if (!inputs.values[channel].empty()) values[run][channel] = std::move(inputs.values[channel]);
    }
    Recording model = with_values(recording, std::move(values));
    model.name += ", model";
    return model;
}

ExitCode simulate_recording(const Invocation& invocation) {
    const Recording recording = read_recording(invocation.repeated_argument().front());
    const auto twin = gap::make_twin(recording, invocation.count("segments"));
    std::vector<double> values = gap::nominal_values(*twin);
    if (invocation.has("parameters"))
        values = gap::read_parameter_values(invocation.text("parameters"), twin->parameters());
    else
        require_stated_numbers(recording, "give them with --parameters, as a calibration writes them");
    std::vector<TwinRun> modelled;
    for (std::size_t run = 0; run < recording.runs.size(); ++run) modelled.push_back(twin->run(run, values));
    deliver_page(invocation, answers::recording_answer(recording, modelled));
    deliver_recording(invocation, model_recording(recording, modelled), {});
    return ExitCode::success;
}

// A model that a diagnosis saved, judged on a recording.
ExitCode judge_model(const Invocation& invocation) {
    const std::set<std::string_view> its_options = {"model", "runs", "csv", "jobs", "output", "html", "json"};
    for (const Option& other : invocation.command().options) {
        if (!its_options.contains(other.name) && invocation.has(other.name) &&
            invocation.text(other.name) != other.default_value)
            throw UsageError(fmt::format("capstan simulate: --{} does not go with --model", other.name));
    }
    const bench_model::BenchModel model = bench_model::read_model(invocation.text("model"));
    Recording recording = read_recording(invocation.repeated_argument().front());
    if (invocation.has("runs"))
        recording = model_comparison::runs_of(recording, run_numbers(invocation.text("runs")));
    const bench_model::ModelPrediction prediction =
        bench_model::predict(model, recording, invocation.count("jobs"));
    if (invocation.has("csv")) write_file(invocation.text("csv"), prediction_csv(recording, prediction));
    deliver_answer(invocation, answers::model_answer(recording, model, prediction));
    return ExitCode::success;
}

ExitCode run_simulate(const Invocation& invocation) {
    const std::string& first = invocation.repeated_argument().front();
    const bool several = invocation.repeated_argument().size() > 1;
    if (!invocation.has("model")) {
        for (const char* option : {"runs", "csv", "json"})
            if (invocation.has(option))
                throw UsageError(fmt::format(
                    "capstan simulate: --{} goes with --model, which judges a model on a recording", option));
    } else if (!names_a_recording(first)) {
        throw UsageError(
            "capstan simulate: --model needs a recording to be judged on, NAME.csv or NAME.json");
    } else if (!several) {
        return judge_model(invocation);
    }
    if (!names_a_recording(first) && config::content_of_config(first) == config::ConfigContent::bench)
        return simulate_bench_files(invocation);
    if (several)
        throw UsageError("capstan simulate: only benches can be several, which become runs of one recording");
    if (names_a_recording(first)) return simulate_recording(invocation);
    if (invocation.has("html")) {
        throw UsageError(
            "capstan simulate: a study's motion has no page; --html is for benches and recordings. `capstan study run` "
            "and `capstan report` make the page of a study");
    }
    const StudyPlan plan = config::read_config(first).plan;
    if (invocation.has("recording")) {
        const bench::Instruments instruments = instruments_of(invocation);
        deliver_recording(invocation, bench::recorded_motion(plan, instruments), instruments);
        return ExitCode::success;
    }
    deliver(invocation, motion_csv(plan));
    return ExitCode::success;
}

const Option parameters_option{
    .name = "parameters",
    .value = "FILE",
    .meaning = "Recordings only: the model's parameters, in a file written by `capstan calibrate --save`."};

const Option judged_model_option{
    .name = "model",
    .value = "FILE",
    .meaning = "Recordings only: judge this model, written by `capstan diagnose --save`, on the recording."};

const Option judged_runs_option{
    .name = "runs", .value = "LIST", .meaning = "With --model: only these runs, for example 2,4."};

const Option predicted_csv_option{
    .name = "csv",
    .value = "FILE",
    .meaning = "With --model: write the predicted channels beside the measured ones to FILE.",
    .check = check_writable};

const Option as_recording_option{
    .name = "recording", .meaning = "Studies only: write the motion as a recording of a single cable."};

const Option sensors_option{
    .name = "sensors",
    .kind = OptionKind::integer,
    .value = "N",
    .meaning = "Recordings of benches and studies: tension sensors on each cable, evenly from end to end.",
    .default_value = "0",
    .limits = {0, 10000}};

const Option sensor_noise_option{
    .name = "sensor-noise",
    .kind = OptionKind::number,
    .value = "FRACTION",
    .meaning =
        "White noise on every channel of such a recording: its standard deviation over the "
        "channel's span.",
    .default_value = "0",
    .limits = {0, 10}};

const Option simulated_kind_option{
    .name = "kind",
    .value = "KIND",
    .meaning = "Benches only: lumped_drive withholds the geometry in the sidecar.",
    .choices = {"pull_pull", "lumped_drive"}};

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
            "and displacement of every node. Use it to find instants for [[regime]]; with --recording, writes the motion of a cable whose "
            "far end is held as a recording. With the configurations of benches (`capstan config default --bench`): simulates two cables "
            "between pulleys and writes a recording, NAME.csv with NAME.json, each bench a run; --html plots the first with the tension "
            "along the cables. With a recording: drives the bench's model with the recording's driven channels and writes, as a recording "
            "again, the inputs (with the noise removed) and the model's prediction of the other channels; --html plots the prediction over "
            "the measurement. With a recording and --model: drives the model that a diagnosis saved with the recording's inputs, and prints "
            "the error of each predicted channel in each run, beside that of the bench without the diagnosis. A recording is also written as MATLAB file (-o NAME.mat: a struct for each run with t, the channels and units) "
            "or MCAP (-o NAME.mcap: a topic for each channel, its unit in the metadata).",
        .arguments = {Argument{
            "CONFIG",
            "A study (TOML), a recording (CSV with its JSON sidecar), or one or more benches (TOML).",
            ArgumentNeed::one_or_more}},
        .options = {judged_model_option, judged_runs_option, predicted_csv_option, parameters_option,
                    segments_option, as_recording_option, sensors_option, sensor_noise_option,
                    simulated_kind_option, seed_option, jobs_option, output_option, page_option, json_option,
                    help_option},
        .examples =
            {"capstan simulate configs/paper.toml -o motion.csv",
             "capstan simulate my.toml | awk -F, '$4 == \"mass\" {print $1}'",
             "capstan simulate configs/bench-slack.toml --html slack.html -o slack.csv",
             "capstan simulate configs/bench-ramps.toml --sensors 3 --sensor-noise 0.002 -o bench.csv",
             "capstan simulate configs/paper.toml --recording --sensors 5 -o cable.csv",
             "capstan simulate bench.csv --parameters fitted.json -o model.csv --html model.html",
             "capstan simulate bench.csv -o model.mcap",
             "capstan simulate later.csv --model model.toml --html judged.html"},
        .run = run_simulate,
        .time = "A hundredth of the simulated time, mostly less than 2 s."};
}

}  // namespace capstan::cli
