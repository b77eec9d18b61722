#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "capstan/cli/answer_format.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/corrected_model.h"
#include "capstan/cli/diagnosis_words.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/log_argument.h"
#include "capstan/cli/output.h"
#include "capstan/cli/page_diagnosis.h"
#include "capstan/cli/stored_diagnosis.h"
#include "capstan/cli/usage_error.h"
#include "capstan/config/config_truth.h"
#include "capstan/gap/diagnosis.h"
#include "capstan/gap/equivalent_bench.h"
#include "capstan/platform/progress.h"
#include "capstan/platform/standard_streams.h"
#include "capstan/recording/estimated_noise.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/reports/diagnosis_report.h"
#include "capstan/storage/diagnosis_store.h"

namespace capstan::cli {

namespace {

using gap::Diagnosis;
using nlohmann::ordered_json;

std::vector<int> run_numbers(const std::string& listed) {
    std::vector<int> numbers;
    std::istringstream words(listed);
    for (std::string word; std::getline(words, word, ',');) {
        int number = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (error != std::errc() || end != word.data() + word.size())
            throw UsageError(fmt::format("'{}' is no run's number; write runs as 1,2,5", word));
        numbers.push_back(number);
    }
    return numbers;
}

// Its runs with these numbers, in a list as of the command line.
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

// A bench of known geometry, or what moves as the recorded one does.
Recording recorded_bench(const Invocation& invocation) {
    const Recording whole = with_estimated_noise(read_recording(invocation.argument("LOG")));
    const Recording diagnosed = invocation.has("runs") ? only_runs(whole, invocation.text("runs")) : whole;
    const Recording fitted_to =
        invocation.has("calibrate-on") ? only_runs(whole, invocation.text("calibrate-on")) : diagnosed;
    return gap::equivalent_bench(diagnosed, fitted_to);
}

void store(const Invocation& invocation, const Recording& recording, const Diagnosis& diagnosis) {
    storage::DiagnosisRecord record = diagnosis_record(recording, diagnosis);
    name_log(record, invocation.argument("LOG"));
    storage::Database database = storage::Database::open_or_create(invocation.text("db"));
    const std::int64_t id = storage::write_diagnosis(database, record);
    if (invocation.text("progress") != "none")
        say(fmt::format("Stored as diagnosis {} in {}.", id, invocation.text("db")));
}

std::string answer_in(const std::string& format, const Recording& recording, const Diagnosis& diagnosis) {
    if (format == "json") return json_text(in_json(recording, diagnosis));
    if (format == "md") return reports::diagnosis_markdown(diagnosis_record(recording, diagnosis));
    if (format == "csv") return reports::diagnosis_csv(diagnosis_record(recording, diagnosis));
    return in_words(recording, diagnosis);
}

ExitCode run(const Invocation& invocation) {
    const Recording recording = recorded_bench(invocation);
    gap::DiagnosisOptions options;
    options.threads = static_cast<int>(invocation.whole("jobs"));
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
    deliver_page(invocation,
                 [&] { return reports::experiment_page_html(diagnosis_page(recording, diagnosis)); });
    if (invocation.has("corrected"))
        write_file(invocation.text("corrected"),
                   corrected_model_text(recording, diagnosis, verdict_sentence(diagnosis)));
    deliver(invocation, answer_in(answer_format(invocation, "words"), recording, diagnosis));
    return ExitCode::success;
}

}  // namespace

const Option runs_option{"runs", '\0', OptionKind::text, "LIST", "Diagnose these runs only, as 4,5,6."};
const Option calibrate_on_option{
    "calibrate-on", '\0', OptionKind::text, "LIST",
    "Runs that a drive or band of unknown geometry gets its numbers from. Default: those diagnosed."};
const Option keep_option{"db", '\0', OptionKind::text, "FILE",
                         "Also keep the diagnosis in this results database; `capstan query \"SELECT * FROM "
                         "v_diagnosis\"` lists them."};

const Option format_option{"format",
                           '\0',
                           OptionKind::text,
                           "words|md|csv|json",
                           "Default: as FILE ends, else words.",
                           "",
                           {"words", "md", "csv", "json"}};

const Option corrected_option{
    "corrected", '\0', OptionKind::text, "FILE",
    "Write the corrected model of the cable to FILE, for capstan study run --truth."};

Command diagnose_command() {
    return {
        "diagnose",
        "Find which unmodelled effect makes a recording disagree with its model.",
        "Moves the bench's model with the recording's driven channels, fits every effect of the catalogue, wrong "
        "parameters and sensor faults to what is left in the other channels, and says which explains it: where it "
        "sits, how probable each is, how far the gap shrinks, also on runs that the fit has not seen. Says `none` "
        "where only noise is left and `unknown` where the best known cause leaves much of the gap. Where explanations "
        "cannot be told apart it says which, and which experiment would decide. Benches are pull_pull, single_cable, or "
        "a drive or band of unknown geometry.",
        {log_argument},
        {runs_option, calibrate_on_option, keep_option, corrected_option, jobs_option, output_option,
         format_option, json_option, page_option, progress_option, help_option},
        {"capstan diagnose bench.csv", "capstan diagnose bench.csv --json -o verdict.json",
         "capstan diagnose bench.csv --html bench.html", "capstan diagnose bench.csv --db bench.db",
         "capstan diagnose bench.csv --corrected corrected.toml"},
        run};
}

}  // namespace capstan::cli
