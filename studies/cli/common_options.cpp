#include "capstan/cli/common_options.h"

#include <fmt/format.h>

#include <sstream>

#include "capstan/cli/output.h"
#include "capstan/cli/program.h"
#include "capstan/config/config_truth.h"
#include "capstan/config/far_end_log.h"
#include "capstan/platform/nearest_name.h"
#include "capstan/platform/parsed_number.h"
#include "capstan/platform/simd_width.h"

namespace capstan::cli {

namespace {

void check_answer_file(const Invocation& invocation, const Option& option) {
    answer_format(invocation, reports::AnswerFormat::text);
    check_writable(invocation, option);
}

void check_page_file(const Invocation& invocation, const Option& option) {
    if (invocation.text(option.name) == "-")
        throw UsageError(
            "--html -: the answer itself goes to standard output; name a file, such as page.html");
    check_writable(invocation, option);
}

}  // namespace

void check_writable(const Invocation& invocation, const Option& option) {
    const std::string& file = invocation.text(option.name);
    if (file != "-") require_writable(file);
}

const Option help_option{.name = "help", .letter = 'h', .meaning = "Explain this command."};
const Option database_option{
    .name = "db", .value = "FILE", .meaning = "The results database.", .default_value = "capstan.db"};
const Option output_option{
    .name = "output",
    .letter = 'o',
    .value = "FILE",
    .meaning = "Write the answer to FILE, which is written completely or not at all; - is standard output.",
    .default_value = "-",
    .check = check_writable};
const Option answer_output_option = [] {
    Option option = output_option;
    option.check = check_answer_file;
    return option;
}();
const Option jobs_option{
    .name = "jobs",
    .letter = 'j',
    .kind = OptionKind::integer,
    .value = "N",
    .meaning = "Number of threads; 0 uses all processors. Any number gives the same bits.",
    .default_value = "0",
    .limits = {0, 1024}};
const Option seed_option{.name = "seed",
                         .kind = OptionKind::integer,
                         .value = "S",
                         .meaning = "Seed of all random numbers, instead of the configuration's.",
                         .limits = {0, 9.2e18}};
const Option repetitions_option{
    .name = "repetitions",
    .kind = OptionKind::integer,
    .value = "N",
    .meaning = "Number of noise draws, instead of the configuration's; a few give a quick look.",
    .limits = {2, 1e7}};
const Option json_option{.name = "json", .meaning = "Print the answer as JSON, for programs."};
const Option progress_option{
    .name = "progress",
    .meaning =
        "Progress on standard error: auto is a bar on a terminal and plain lines elsewhere, json is "
        "one object per line.",
    .default_value = "auto",
    .choices = {"auto", "json", "none"}};
const Option stats_option{.name = "stats",
                          .meaning = "Print on standard error how much time each stage took."};
const Option simd_option{
    .name = "simd",
    .value = "WIDTH",
    .meaning =
        "Use no wider vector instructions than WIDTH (SSE4, AVX2, ...), so that different processors give the "
        "same last bits; `capstan doctor` prints those in use. By default those with which the study was begun, "
        "if this processor has them, otherwise its widest."};
const Option segments_option{
    .name = "segments",
    .kind = OptionKind::integer,
    .value = "N",
    .meaning =
        "Segments per cable in the model of a recorded bench. Friction at rest depends on their "
        "length; above about 100 segments the result changes by less than 1%.",
    .default_value = "100",
    .limits = {2, 100000}};

const Option format_option{.name = "format",
                           .meaning = "Default: by the extension of the output file, otherwise text.",
                           .choices = {"text", "md", "csv", "json"}};

const Option page_option{
    .name = "html",
    .value = "FILE",
    .meaning = "Also write FILE, one self-contained page of figures and numbers; open it in a browser.",
    .check = check_page_file};

const Argument config_argument{
    "CONFIG", "The study's configuration (TOML); `capstan config default` explains every key."};
const Argument study_argument{"STUDY", "Its number, its name (the newest study of that name), or latest.",
                              ArgumentNeed::optional, "latest"};

void use_stated_simd(const Invocation& invocation) {
    if (invocation.has("simd")) limit_simd(invocation.text("simd"), "--simd ");
}

void use_simd_of(const Invocation& invocation, const std::vector<storage::Computation>& computations) {
    use_stated_simd(invocation);
    if (invocation.has("simd") || simd_is_limited() || computations.size() != 1) return;
    limit_simd_width(computations.front().simd);  // false: not here, which is said where it matters
}

config::ReadConfig read_config_of(const Invocation& invocation) {
    if (names_a_recording(invocation.argument("CONFIG")))
        throw UsageError(
            fmt::format("{} is a recording, but `capstan {}` takes the configuration of a study (TOML); "
                        "`capstan diagnose` and `capstan estimate` take recordings",
                        invocation.argument("CONFIG"), invocation.command().name));
    config::ReadConfig config = config::read_config(invocation.argument("CONFIG"));
    StudyPlan& plan = config.plan;
    invocation.take("seed", plan.seed);
    invocation.take("repetitions", plan.repetitions);
    if (invocation.has("far-end")) {
        if (!plan.uncertainty.is_stated)
            throw UsageError("capstan: --far-end needs a CONFIG with [uncertainty], whose far end it moves");
        config::take_far_end_log(config, invocation.text("far-end"));
    }
    if (invocation.has("truth")) plan.truth = config::read_truth(invocation.text("truth"));
    return config;
}

const Option far_end_option{
    .name = "far-end",
    .value = "LOG",
    .meaning =
        "The far end of a CONFIG with [uncertainty] moves as LOG recorded it, in each world another stretch: a CSV "
        "file with the columns time_s and displacement_m. The estimator assumes a random motion with the log's "
        "range and bandwidth, or with those that CONFIG states."};

const Option noise_option{.name = "noise",
                          .value = "LABEL",
                          .meaning = "Which of the configuration's noise levels; the first if not given."};

int noise_index_of(const StudyPlan& plan, const Invocation& invocation) {
    if (!invocation.has("noise")) return 0;
    std::vector<std::string> labels;
    for (std::size_t k = 0; k < plan.noise_levels.size(); ++k) {
        labels.push_back(plan.noise_levels[k].label);
        if (labels.back() == invocation.text("noise")) return static_cast<int>(k);
    }
    throw UsageError(fmt::format("--noise: the configuration has no noise level \"{}\"{}",
                                 invocation.text("noise"), suggestion(invocation.text("noise"), labels)));
}

const Argument log_argument{
    "LOG",
    "A recording: NAME.csv with NAME.json beside it, which says what the columns are; either name is taken."};

std::vector<std::string> split_at_commas(const std::string& listed) {
    std::vector<std::string> parts;
    std::istringstream stream(listed);
    for (std::string part; std::getline(stream, part, ',');)
        if (!part.empty()) parts.push_back(part);
    return parts;
}

std::vector<std::string> split_at_blanks(const std::string& text) {
    std::vector<std::string> words;
    std::istringstream stream(text);
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

std::vector<int> run_numbers(const std::string& listed) {
    std::vector<int> numbers;
    std::istringstream words(listed);
    for (std::string word; std::getline(words, word, ',');) {
        const auto number = parsed_number<int>(word);
        if (!number)
            throw UsageError(fmt::format("'{}' is not a run number; write a list such as 1,2,5", word));
        numbers.push_back(*number);
    }
    return numbers;
}

bool names_a_recording(const std::filesystem::path& path) {
    return path.extension() == ".csv" || path.extension() == ".json";
}

}  // namespace capstan::cli
