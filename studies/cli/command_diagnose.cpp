#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "capstan/answers/recording_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/config/config_truth.h"
#include "capstan/export/series.h"
#include "capstan/gap/diagnosis.h"
#include "capstan/gap/equivalent_bench.h"
#include "capstan/platform/progress.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/recording/recording_writer.h"
#include "capstan/storage/diagnosis_store.h"

namespace capstan::cli {

namespace {

// Where a fitted cause stands in the engine's catalogue; past the end for wrong numbers and sensors. A study
// has one cable: a bend of either of two is its own.
std::size_t catalogue_index(const gap::FittedCause& cause) {
    const std::string variant = cause.variant == "cable B" ? "cable A" : cause.variant;
    std::size_t index = 0;
    while (index < effect_catalogue().size() &&
           (effect_catalogue()[index].name != cause.effect || effect_catalogue()[index].variant != variant))
        ++index;
    return index;
}

std::vector<double> values_of(const Effect& effect, const gap::FittedCause& cause) {
    std::vector<double> values = effect.absent;
    for (std::size_t k = 0; k < effect.parameters.size(); ++k) {
        for (const gap::FittedNumber& number : cause.numbers) {
            if (number.name == effect.parameters[k].name) values[k] = number.value;
        }
    }
    return values;
}

std::string corrected_model_text(const Recording& recording, const gap::Diagnosis& diagnosis,
                                 const std::string& verdict) {
    std::vector<std::string> comments = {
        fmt::format("The model of {} as `capstan diagnose` corrects it.", recording.name), verdict,
        "For `capstan study run CONFIG --truth THIS_FILE`: ratios are in parts of what CONFIG says."};
    TrueCable truth{diagnosis.friction_ratio, diagnosis.stiffness_ratio, diagnosis.pretension_ratio,
                    absent_effects()};
    for (const gap::FittedCause& cause : diagnosis.causes) {
        const std::size_t index = catalogue_index(cause);
        if (index < effect_catalogue().size() && effect_catalogue()[index].changes_the_cable) {
            truth.effects[index] = values_of(effect_catalogue()[index], cause);
        } else if (!cause.numbers.empty()) {
            comments.push_back(fmt::format("Not in here, for it is not of the cable: {}{}{}.", cause.effect,
                                           cause.variant.empty() ? "" : ", ", cause.variant));
        }
    }
    return config::truth_text(truth, comments);
}

using gap::Diagnosis;

std::vector<int> run_numbers(const std::string& listed) {
    std::vector<int> numbers;
    std::istringstream words(listed);
    for (std::string word; std::getline(words, word, ',');) {
        int number = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (error != std::errc() || end != word.data() + word.size())
            throw UsageError(fmt::format("'{}' is not a run number; write a list such as 1,2,5", word));
        numbers.push_back(number);
    }
    return numbers;
}

// Keeps only the runs of a list such as 1,2,5.
Recording only_runs(Recording recording, const std::string& listed) {
    std::vector<RecordedRun> runs;
    for (const int number : run_numbers(listed)) {
        const auto run = std::find_if(recording.runs.begin(), recording.runs.end(),
                                      [&](const RecordedRun& each) { return each.number == number; });
        if (run == recording.runs.end())
            throw UsageError(fmt::format("{}: there is no run {}", recording.name, number));
        runs.push_back(*run);
    }
    recording.runs = std::move(runs);
    return recording;
}

// The recorded bench, or an equivalent bench where the geometry is unknown.
Recording recorded_bench(const Invocation& invocation) {
    const Recording recorded = read_recording(invocation.argument("LOG"));
    const Recording diagnosed =
        invocation.has("runs") ? only_runs(recorded, invocation.text("runs")) : recorded;
    const Recording fitted_to =
        invocation.has("calibrate-on") ? only_runs(recorded, invocation.text("calibrate-on")) : diagnosed;
    return gap::equivalent_bench(diagnosed, fitted_to);
}

void store(const Invocation& invocation, const Recording& recording, const Diagnosis& diagnosis) {
    storage::Database database = storage::Database::open_or_create(invocation.text("db"));
    const std::int64_t id = storage::write_diagnosis(
        database, answers::diagnosis_record(recording, diagnosis, invocation.argument("LOG")));
    if (invocation.text("progress") != "none")
        say(fmt::format("Stored as diagnosis {} in {}.", id, invocation.text("db")));
}

// The channels that the corrected model predicts.
void write_prediction(const std::filesystem::path& file, Recording recording, const Diagnosis& diagnosis) {
    if (!exports::is_series_file(file) && file.extension() != ".csv")
        throw UsageError(fmt::format("capstan diagnose: --prediction {} should end in .csv, .mat or .mcap",
                                     file.string()));
    for (std::size_t channel = recording.channels.size(); channel-- > 0;) {
        const auto at = static_cast<std::ptrdiff_t>(channel);
        const bool is_known = std::all_of(diagnosis.gap.leading.begin(), diagnosis.gap.leading.end(),
                                          [&](const auto& run) { return !run.values[channel].empty(); });
        if (!is_known) recording.channels.erase(recording.channels.begin() + at);
        for (std::size_t run = 0; run < recording.runs.size(); ++run) {
            auto& values = recording.runs[run].values;
            if (is_known)
                values[channel] = diagnosis.gap.leading[run].values[channel];
            else
                values.erase(values.begin() + at);
        }
    }
    if (exports::is_series_file(file))
        exports::write_series(file, exports::series_of(recording));
    else
        write_file(file, samples_csv(recording));
}

ExitCode run_diagnose(const Invocation& invocation) {
    const Recording recording = recorded_bench(invocation);
    gap::DiagnosisOptions options;
    options.threads = static_cast<int>(invocation.integer("jobs"));
    ProgressDisplay display(progress_mode(invocation.text("progress")));
    options.on_progress = [&](const std::string& activity, double fraction) {
        ProgressEvent event;
        event.activity = activity;
        event.fraction = fraction;
        display.show(event);
    };
    const Diagnosis diagnosis = gap::diagnose(recording, options);
    display.end_line();
    if (invocation.has("db")) store(invocation, recording, diagnosis);
    if (invocation.has("corrected"))
        write_file(invocation.text("corrected"),
                   corrected_model_text(recording, diagnosis, answers::verdict_sentence(diagnosis)));
    if (invocation.has("prediction")) write_prediction(invocation.text("prediction"), recording, diagnosis);
    deliver_answer(invocation, answers::diagnosis_answer(recording, diagnosis));
    return ExitCode::success;
}

}  // namespace

const Option runs_option{
    .name = "runs", .value = "LIST", .meaning = "Diagnose only these runs, for example 4,5,6."};
const Option calibrate_on_option{
    .name = "calibrate-on",
    .value = "LIST",
    .meaning =
        "Runs to which a drive or band of unknown geometry is calibrated. Default: the diagnosed "
        "runs."};
const Option keep_option{
    .name = "db",
    .value = "FILE",
    .meaning =
        "Also store the diagnosis in this results database; `capstan query \"SELECT * FROM "
        "v_diagnosis\"` lists the stored diagnoses."};

const Option corrected_option{
    .name = "corrected",
    .value = "FILE",
    .meaning = "Write the corrected model of the cable to FILE, for `capstan study run --truth FILE`."};

const Option prediction_option{
    .name = "prediction",
    .value = "FILE",
    .meaning = "Write what the corrected model predicts to FILE: .csv, .mat (MATLAB) or .mcap."};

Command diagnose_command() {
    return {.name = "diagnose",
            .summary = "Find which unmodelled effect makes a recording disagree with its model.",
            .description =
                "Drives the bench's model with the recording's driven channels and fits every effect of the "
                "catalogue, wrong parameters and sensor faults to the residuals of the other channels. Names "
                "the most probable cause and its location, and prints the probability of each cause and how "
                "far the gap shrinks, also on runs that the fit did not use. The verdict is `none` where "
                "only noise remains and `unknown` where the best known cause leaves much of the gap. Where "
                "causes cannot be distinguished, it lists them and the experiment that would distinguish "
                "them. Benches are pull_pull, single_cable, or a drive or band of unknown geometry.",
            .arguments = {log_argument},
            .options = {runs_option, calibrate_on_option, keep_option, corrected_option, prediction_option,
                        jobs_option, output_option, format_option, json_option, page_option, progress_option,
                        help_option},
            .examples = {"capstan diagnose bench.csv", "capstan diagnose bench.csv --json -o verdict.json",
                         "capstan diagnose bench.csv --html bench.html",
                         "capstan diagnose bench.csv --db bench.db",
                         "capstan diagnose bench.csv --corrected corrected.toml"},
            .run = run_diagnose};
}

}  // namespace capstan::cli
