#include <fmt/format.h>

#include "capstan/answers/study_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/config/config_file.h"
#include "capstan/config/config_problem.h"
#include "capstan/config/config_reader.h"
#include "capstan/config/config_writer.h"
#include "capstan/config/plan_checks.h"

namespace capstan::cli {

namespace {

using reports::Data;

ExitCode run_config_default(const Invocation& invocation) {
    deliver(invocation, invocation.has("bench")
                            ? config::config_text(config::default_bench(), config::Comments::every_key)
                            : config::config_text(config::default_plan(), config::Comments::every_key));
    return ExitCode::success;
}

}  // namespace

Command config_default_command() {
    return {
        .name = "config default",
        .summary = "Print a complete configuration with every key explained.",
        .description =
            "Prints a complete configuration: every key with its meaning, unit, limits and default. It "
            "can be run without changes.",
        .options = {{.name = "bench",
                     .meaning =
                         "Print the configuration of a bench, for `capstan simulate`, instead of a study's."},
                    output_option,
                    help_option},
        .examples = {"capstan config default -o my.toml", "capstan config default --bench -o bench.toml"},
        .run = run_config_default};
}

namespace {

std::string bench_in_words(const std::string& file, const bench::BenchPlan& plan) {
    std::string text = fmt::format("{}: ok\n  a bench: {} segments to a cable, {} samples", file,
                                   plan.cable.segments, plan.samples());
    for (const std::string& effect : effects_there(plan.effects)) text += ", " + effect;
    return text + "\n";
}

Data bench_in_json(const bench::BenchPlan& plan) {
    return {{"ok", true},
            {"kind", "bench"},
            {"name", plan.name},
            {"segments", plan.cable.segments},
            {"samples", plan.samples()},
            {"effects", effects_there(plan.effects)}};
}

// Builds the cable, which also checks combinations of keys.
void check_bench(const Invocation& invocation, const std::string& file) {
    const bench::BenchPlan plan = config::read_bench(file).plan;
    const Cable cable(plan.cable);
    deliver(invocation,
            invocation.has("json") ? reports::json_text(bench_in_json(plan)) : bench_in_words(file, plan));
}

Data problems_data(const config::ConfigError& error) {
    Data json = {{"ok", false}, {"problems", Data::list()}};
    for (const config::ConfigProblem& problem : error.at_lines()) {
        json["problems"].push_back({{"line", problem.line},
                                    {"column", problem.column},
                                    {"key", problem.key},
                                    {"message", problem.message}});
    }
    return json;
}

ExitCode run_config_check(const Invocation& invocation) {
    const std::string& file = invocation.argument("CONFIG");
    try {
        if (config::content_of_config(file) == config::ConfigContent::bench) {
            check_bench(invocation, file);
            return ExitCode::success;
        }
        const config::ReadConfig config = config::read_config(file);
        const std::vector<StudyPlan> studies = config::runnable_studies(config);
        deliver(invocation, invocation.has("json")
                                ? reports::json_text(answers::plan_size_data(config.plan, studies))
                                : answers::plan_size_text(file, config.plan, studies));
        return ExitCode::success;
    } catch (const config::ConfigError& error) {
        if (!invocation.has("json")) throw;
        deliver(invocation, reports::json_text(problems_data(error)));
        return ExitCode::wrong_input;
    }
}

}  // namespace

Command config_check_command() {
    return {.name = "config check",
            .summary = "Check a configuration; list every problem with its line.",
            .description =
                "Checks the configuration of a study or a bench without running it. Of a study only the true "
                "motion is simulated, to check that each instant is in its regime. Prints ok and the size of "
                "the study, or every problem with its line and a suggestion.",
            .arguments = {config_argument},
            .options = {output_option, json_option, help_option},
            .examples = {"capstan config check my.toml"},
            .run = run_config_check};
}

Command config_catalogue_command() {
    return {
        .name = "config catalogue",
        .summary = "List the effects, layouts and fusion methods, with the keys of each effect.",
        .description =
            "Lists what a configuration can name: effects of a bench, each with its equation and the section "
            "that switches it on, layout families and fusion methods; and the other causes that a diagnosis can "
            "name. --json also has the parameters of each effect with limits and a typical value, and the causes "
            "that are confusable with it.",
        .options = {format_option, output_option, json_option, help_option},
        .examples = {"capstan config catalogue", "capstan config catalogue --json -o catalogue.json"},
        .run = [](const Invocation& invocation) {
            deliver_answer(invocation, answers::catalogue_answer());
            return ExitCode::success;
        }};
}

}  // namespace capstan::cli
