#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "capstan/answers/recording_answers.h"
#include "capstan/bench_model/model_file.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/program.h"
#include "capstan/export/series.h"
#include "capstan/model_comparison/diagnosed_runs.h"
#include "capstan/model_comparison/diagnosis_cost.h"
#include "capstan/platform/clocks.h"
#include "capstan/platform/freed_memory.h"
#include "capstan/platform/progress.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/recording/driven_inputs.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/recording/recording_writer.h"
#include "capstan/storage/diagnosis_store.h"

namespace capstan::cli {

namespace {

using gap::Diagnosis;

// Which runs are fitted, judged and compared, as the options say.
model_comparison::DiagnosisRequest asked_runs(const Invocation& invocation) {
    model_comparison::DiagnosisRequest request;
    const std::pair<const char*, std::vector<int>*> lists[] = {{"runs", &request.runs},
                                                               {"calibrate-on", &request.calibrate_on},
                                                               {"fit", &request.fit},
                                                               {"hold", &request.hold}};
    for (const auto& [option, numbers] : lists)
        if (invocation.has(option)) *numbers = run_numbers(invocation.text(option));
    request.with_simple_models = invocation.has("baselines");
    return request;
}

void store(const Invocation& invocation, storage::Database& database, const Recording& recording,
           const Diagnosis& diagnosis) {
    const std::int64_t id = storage::write_diagnosis(
        database, answers::diagnosis_record(recording, diagnosis, invocation.argument("LOG")));
    if (invocation.text("progress") != "none")
        say(fmt::format("Stored as diagnosis {} in {}.", id, invocation.text("db")));
}

void save_model(const std::filesystem::path& file, const model_comparison::DiagnosedSplit& diagnosed,
                const std::vector<model_comparison::LeftOver>& left, const gap::DiagnosisOptions& options) {
    const bench_model::ModelOrigin origin{diagnosed.recorded.name, diagnosed.split.fit, program_version(),
                                          answers::verdict_sentence(diagnosed.diagnosis)};
    bench_model::write_model(file, bench_model::model_of(diagnosed, left, origin, options));
}

void check_prediction_file(const Invocation& invocation, const Option& option) {
    const std::filesystem::path file = invocation.text(option.name);
    if (!exports::is_series_file(file) && file.extension() != ".csv")
        throw UsageError(fmt::format("capstan diagnose: --prediction {} should end in .csv, .mat or .mcap",
                                     file.string()));
    check_writable(invocation, option);
}

void check_model_file(const Invocation& invocation, const Option& option) {
    bench_model::require_model_name(invocation.text(option.name));
    check_writable(invocation, option);
}

// The channels that the corrected model predicts.
void write_prediction(const std::filesystem::path& file, const Recording& recording,
                      const Diagnosis& diagnosis) {
    std::vector<std::vector<std::vector<double>>> values;  // runs x channels x samples
    for (const gap::TwinRun& run : diagnosis.gap.leading) values.push_back(run.values);
    const Recording predicted = with_values(recording, std::move(values));
    if (exports::is_series_file(file))
        exports::write_series(file, exports::series_of(predicted));
    else
        write_file(file, samples_csv(predicted));
}

// What a search finds decides how long it goes on, so that the bar is of the longest time, and the time left
// is a range; neither is told of a search that takes longer.
class DiagnosisProgress {
  public:
    DiagnosisProgress() = default;
    explicit DiagnosisProgress(const model_comparison::DiagnosisCost& cost)
        : min_s_(cost.min_seconds), max_s_(cost.max_seconds) {}

    ProgressEvent event(const std::string& activity) const {
        constexpr double almost_all = 0.95;
        const double taken_s = wall_time_s() - begun_s_;
        ProgressEvent event{.activity = activity, .is_steady = false};
        event.fraction = max_s_ > 0.0 ? std::min(almost_all, taken_s / max_s_) : 0.0;
        if (taken_s >= max_s_) return event;
        event.seconds_left = std::max(0.0, min_s_ - taken_s);
        event.max_seconds_left = max_s_ - taken_s;
        return event;
    }

  private:
    double min_s_ = 0.0;
    double max_s_ = 0.0;
    double begun_s_ = wall_time_s();
};

ExitCode run_diagnose(const Invocation& invocation) {
    keep_freed_memory();
    const Recording recorded = read_recording(invocation.argument("LOG"));
    gap::DiagnosisOptions options;
    options.threads = invocation.count("jobs");
    invocation.take("time-limit", options.time_limit_s);
    if (invocation.has("cost")) {
        deliver_answer(invocation, answers::diagnosis_cost_answer(
                                       recorded.name, model_comparison::predict_diagnosis_cost(
                                                          recorded, asked_runs(invocation), options)));
        return ExitCode::success;
    }
    ProgressDisplay display(progress_mode(invocation.text("progress")));
    DiagnosisProgress progress;
    options.on_progress = [&](const std::string& activity, double) {
        display.show(progress.event(activity));
    };
    std::optional<storage::Database> database;
    const auto begin = [&](const model_comparison::DiagnosisCost& cost) {
        // Before the work whose result it takes.
        if (invocation.has("db")) database.emplace(storage::Database::open_or_create(invocation.text("db")));
        progress = DiagnosisProgress(cost);
    };
    const model_comparison::DiagnosedRuns diagnosed =
        model_comparison::diagnose_runs(recorded, asked_runs(invocation), options, begin);
    const Recording& recording = diagnosed.split.diagnosed;
    const Diagnosis& diagnosis = diagnosed.split.diagnosis;
    display.show({.activity = "the answer", .fraction = 1.0});
    display.end_line();
    if (diagnosis.cut_short)
        say("The time limit ended the search: further causes were not tried, and the answer is the best so far.");
    if (database) store(invocation, *database, recording, diagnosis);
    if (invocation.has("corrected"))
        write_file(invocation.text("corrected"), answers::corrected_model_text(recording, diagnosis));
    if (invocation.has("prediction")) write_prediction(invocation.text("prediction"), recording, diagnosis);
    if (invocation.has("save"))
        save_model(invocation.text("save"), diagnosed.split, diagnosed.left_over, options);
    deliver_answer(invocation, answers::diagnosed_runs_answer(diagnosed));
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
const Option fit_option{
    .name = "fit",
    .value = "LIST",
    .meaning = "Calibrate and diagnose on these runs only, and judge the corrected model on the others."};
const Option hold_option{
    .name = "hold",
    .value = "LIST",
    .meaning = "The runs on which the corrected model is judged. Default: those that are not fitted."};
const Option baselines_option{
    .name = "baselines",
    .meaning =
        "Also fit simple models that know nothing of the bench, and print the errors of all models on fitted "
        "and held-out runs. Without --fit and --hold, every other run is held out, then the rest."};
const Option keep_option{
    .name = "db",
    .value = "FILE",
    .meaning =
        "Also store the diagnosis in this results database; `capstan query \"SELECT * FROM "
        "v_diagnosis\"` lists the stored diagnoses."};

const Option save_model_option{
    .name = "save",
    .value = "FILE",
    .meaning =
        "Write what was found as a model (TOML): the bench, its effects and sensors with intervals, and the law of what "
        "is left. `capstan simulate LOG --model FILE` judges it on other runs.",
    .check = check_model_file};
const Option corrected_option{
    .name = "corrected",
    .value = "FILE",
    .meaning = "Write the corrected model of the cable to FILE, for `capstan study run --truth FILE`.",
    .check = check_writable};

const Option prediction_option{
    .name = "prediction",
    .value = "FILE",
    .meaning = "Write what the corrected model predicts to FILE: .csv, .mat (MATLAB) or .mcap.",
    .check = check_prediction_file};

const Option time_limit_option{
    .name = "time-limit",
    .kind = OptionKind::number,
    .value = "S",
    .meaning = "After S seconds no further cause is tried, and the best answer so far is given.",
    .limits = {1, 86400}};

const Option cost_option{
    .name = "cost",
    .meaning =
        "Only say how long the diagnosis would take on this machine, from a pilot of half a second. Nothing is "
        "diagnosed or written."};

Command diagnose_command() {
    return {
        .name = "diagnose",
        .summary = "Find which unmodelled effect makes a recording disagree with its model.",
        .description =
            "Drives the bench's model with the recording's driven channels and fits every effect of the "
            "catalogue, wrong parameters and sensor faults to the residuals of the other channels, alone and "
            "together. Names the most probable causes and where they are, and prints the probability of each "
            "and how far the gap shrinks, also on runs that the fit did not use. The verdict is `none` where "
            "only noise remains and `unknown` where a structure remains that no known cause explains. Where "
            "causes cannot be distinguished, it lists them and the experiment that would distinguish "
            "them. Benches are pull_pull, single_cable, or a drive or band of unknown geometry.",
        .arguments = {log_argument},
        .options = {runs_option, calibrate_on_option, fit_option, hold_option, baselines_option, keep_option,
                    save_model_option, corrected_option, prediction_option, time_limit_option, cost_option,
                    jobs_option, answer_output_option, format_option, json_option, page_option,
                    progress_option, help_option},
        .examples = {"capstan diagnose bench.csv", "capstan diagnose bench.csv --cost",
                     "capstan diagnose bench.csv --json -o verdict.json",
                     "capstan diagnose bench.csv --html bench.html",
                     "capstan diagnose bench.csv --fit 1,3,5 --hold 2,4,6 --baselines",
                     "capstan diagnose bench.csv --db bench.db",
                     "capstan diagnose bench.csv --fit 1,3 --save model.toml",
                     "capstan diagnose bench.csv --corrected corrected.toml"},
        .run = run_diagnose,
        .time =
            "Seconds to some minutes, by the length of the recording and by what it finds; --cost says how long on this machine. "
            "Shows progress and the time left."};
}

}  // namespace capstan::cli
