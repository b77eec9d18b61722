#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>

#include "capstan/answers/recording_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/import/column_list.h"
#include "capstan/import/importer.h"
#include "capstan/platform/progress.h"
#include "capstan/recording/json_object.h"
#include "capstan/recording/recording_keys.h"
#include "capstan/recording/recording_reader.h"
#include "capstan/suggestion/suggestion.h"

namespace capstan::cli {

namespace {

const Option kind_option{.name = "kind",
                         .value = "KIND",
                         .meaning = "The kind of bench: pull_pull, single_cable, lumped_drive or band.",
                         .choices = {"pull_pull", "single_cable", "lumped_drive", "band"}};

std::vector<std::filesystem::path> log_files(const Invocation& invocation) {
    std::vector<std::filesystem::path> files;
    for (const std::string& file : invocation.repeated_argument()) files.emplace_back(file);
    return files;
}

std::function<void(const std::string&, double)> shown_on(ProgressDisplay& display) {
    return [&display](const std::string& activity, double fraction) {
        display.show({.activity = activity, .fraction = fraction});
    };
}

ExitCode suggest(const Invocation& invocation, ProgressDisplay& display) {
    if (invocation.has("mapping"))
        throw UsageError(
            "capstan import: --suggest proposes a mapping anew and would not read --mapping; give one of the two");
    const std::filesystem::path file = invocation.text("output");
    if (std::filesystem::is_regular_file(file)) {
        throw UsageError(fmt::format(
            "capstan import: {} exists and may hold corrections; give another name with -o, or remove it",
            file.string()));
    }
    imports::SuggestOptions options;
    if (invocation.has("kind")) options.mode = mode_named(invocation.text("kind"));
    options.on_progress = shown_on(display);
    const imports::Suggestion suggestion = imports::suggest_mapping(log_files(invocation), options);
    display.end_line();
    const auto doubtful =
        std::count_if(suggestion.guesses.begin(), suggestion.guesses.end(),
                      [](const auto& guess) { return guess.doubt == imports::Doubt::doubtful; });
    if (invocation.has("json")) {
        reports::Data guesses = reports::Data::list();
        for (const imports::Guess& guess : suggestion.guesses)
            guesses.push_back({{"about", guess.about},
                               {"doubt", guess.doubt == imports::Doubt::doubtful ? "doubtful"
                                         : guess.doubt == imports::Doubt::likely ? "likely"
                                                                                 : "note"},
                               {"reason", guess.reason}});
        deliver(invocation, reports::json_text({{"mapping", suggestion.text()}, {"guesses", guesses}}));
    } else {
        deliver(invocation, suggestion.text());
    }
    say(fmt::format(
        "{} of the {} guesses {} doubtful. Read each, correct the file, then import with --mapping.",
        doubtful, suggestion.guesses.size(), doubtful == 1 ? "is" : "are"));
    return ExitCode::success;
}

std::filesystem::path mapping_of(const Invocation& invocation) {
    if (invocation.has("mapping")) return invocation.text("mapping");
    if (std::filesystem::exists("import.toml")) return "import.toml";
    throw UsageError(
        "capstan import: no mapping says which column is which channel. Let one be proposed with `capstan import --suggest LOG... "
        "-o import.toml`, correct it, and import again with --mapping import.toml");
}

ExitCode run_import(const Invocation& invocation) {
    ProgressDisplay display(progress_mode(invocation.text("progress")), std::chrono::seconds(1));
    if (invocation.has("list")) {
        const imports::ColumnList list = imports::list_columns(log_files(invocation), shown_on(display));
        display.end_line();
        deliver_answer(invocation, answers::column_list_answer(list));
        return ExitCode::success;
    }
    if (invocation.has("suggest")) return suggest(invocation, display);
    const imports::Mapping mapping = imports::read_mapping(mapping_of(invocation));
    imports::ImportOptions options;
    options.strict = invocation.has("strict");
    options.on_progress = shown_on(display);
    if (!invocation.has("try") && invocation.text("output") == "-")
        throw UsageError(
            "capstan import: name the recording with -o NAME (NAME.csv and NAME.json are written), or look at it first "
            "with --try");
    const imports::ImportReport report =
        invocation.has("try")
            ? imports::try_import(log_files(invocation), mapping, options)
            : imports::import_logs(log_files(invocation), mapping, invocation.text("output"), options);
    display.end_line();
    const reports::Answer answer = answers::import_answer(report);
    deliver_page(invocation, answer);
    write_standard_output(reports::answer_in(
        answer, invocation.has("json") ? reports::AnswerFormat::json : reports::AnswerFormat::text));
    return ExitCode::success;
}

const Argument recording_argument{"LOG",
                                  "A recording: NAME.csv with NAME.json beside it; either name, or NAME."};

ExitCode run_recording_check(const Invocation& invocation) {
    ProblemList problems;
    const std::filesystem::path name = invocation.argument("LOG");
    Recording recording = read_recording(name, problems);
    if (recording.name.empty()) recording.name = recording_paths(name).samples.stem().string();
    deliver_answer(invocation, answers::recording_check_answer(recording, problems.listed(SIZE_MAX)));
    return problems.empty() ? ExitCode::success : ExitCode::wrong_input;
}

ExitCode run_recording_template(const Invocation& invocation) {
    deliver(invocation, recording_template(*mode_named(invocation.text("kind"))));
    return ExitCode::success;
}

ExitCode run_recording_keys(const Invocation& invocation) {
    deliver_answer(invocation, answers::recording_keys_answer());
    return ExitCode::success;
}

ExitCode run_recording_schema(const Invocation& invocation) {
    deliver(invocation, recording_schema());
    return ExitCode::success;
}

}  // namespace

Command import_command() {
    return {
        .name = "import",
        .summary = "Turn a laboratory's logs into a recording.",
        .description =
            "Reads logs as laboratories write them (delimited text, MATLAB .mat, HDF5, ROS bags, rosbag2 .db3, MCAP, Excel) by a mapping, "
            "the file import.toml, which says which column or topic is which channel, in which unit, with which sign and zero. Writes "
            "a recording: NAME.csv with NAME.json. Everything that differs from the log is listed as a repair: dropped and missing "
            "samples, gaps, resampling, shifted clocks, unwound counters; so is what looks wrong: units, signs, exchanged columns, "
            "saturated sensors. --suggest proposes the mapping: each guess has its reason and its doubt, and the file is for you to "
            "correct. The same logs and mapping give the same bytes. A mapping: time = { column = \"Time\", unit = \"ms\" }, then "
            "[channels] with lines such as motor_angle = { column = \"Motor\", unit = \"deg\", sign = -1 }, [recording] with the keys of "
            "`capstan recording keys` (mode, nominal, ...), and a [[runs]] for each run (file, from_s, to_s, T0, ...). Further keys of "
            "a channel: table (a topic), file, scale (SI units in one of the column's), counts_per_turn, torque_constant_Nm_per_A, "
            "zero, clock_offset_s, wraps_at, noise_std, step; at the top: sample_rate_Hz, thinning (pick or mean), run_column.",
        .arguments = {Argument{"FILES", "The logs. Files with the same columns are runs of one recording.",
                               ArgumentNeed::one_or_more}},
        .options =
            {{.name = "mapping",
              .value = "FILE",
              .meaning = "The mapping; import.toml where it is left out."},
             {.name = "suggest", .meaning = "Propose a mapping and write it where --output says."},
             {.name = "list",
              .meaning = "List the tables and columns of the logs with their units and ranges."},
             kind_option,
             {.name = "strict", .meaning = "Repair nothing: refuse logs that would need it."},
             {.name = "try", .meaning = "Say what an import would do, and write no recording."},
             {.name = "output",
              .letter = 'o',
              .value = "NAME",
              .meaning =
                  "Where to write: NAME.csv and NAME.json, or the suggested mapping; - is standard output.",
              .default_value = "-"},
             json_option,
             page_option,
             progress_option,
             help_option},
        .examples = {"capstan import --list run7.mcap", "capstan import --suggest run7.csv -o import.toml",
                     "capstan import run7.csv --mapping import.toml -o bench",
                     "capstan import monday.bag tuesday.bag -o session --html session.html",
                     "capstan import run7.mcap --try --strict"},
        .run = run_import,
        .time = "About a second for 10 MB of log. Shows progress."};
}

Command recording_check_command() {
    return {
        .name = "recording check",
        .summary = "Check a recording; list every problem with its place.",
        .description =
            "Reads a recording as every other command does and lists all its problems at once, equal ones together with "
            "the number of their lines; or, where it can be used, what was taken for the keys that its sidecar leaves "
            "out.",
        .arguments = {recording_argument},
        .options = {output_option, json_option, help_option},
        .examples = {"capstan recording check bench.csv"},
        .run = run_recording_check};
}

Command recording_template_command() {
    Option kind = kind_option;
    kind.default_value = "pull_pull";
    return {
        .name = "recording template",
        .summary = "Print the description of a recording to fill in.",
        .description =
            "Prints a NAME.json with every key of a kind of bench at an example. `capstan recording keys` explains each.",
        .options = {kind, output_option, help_option},
        .examples = {"capstan recording template --kind single_cable -o bench.json"},
        .run = run_recording_template};
}

Command recording_keys_command() {
    return {
        .name = "recording keys",
        .summary = "Explain every key and column of a recording.",
        .description =
            "Prints the table of keys of NAME.json (unit, meaning, default, example) and the columns of NAME.csv.",
        .options = {format_option, output_option, json_option, help_option},
        .examples = {"capstan recording keys", "capstan recording keys --format md -o recording.md"},
        .run = run_recording_keys};
}

Command recording_schema_command() {
    return {.name = "recording schema",
            .summary = "Print the JSON schema of a recording's description.",
            .description =
                "Prints the keys of NAME.json as a JSON schema (draft 2020-12), for editors and validators.",
            .options = {output_option, help_option},
            .examples = {"capstan recording schema -o recording.schema.json"},
            .run = run_recording_schema};
}

}  // namespace capstan::cli
