#include "capstan/answers/paper_answers.h"
#include "capstan/cable/invalid_input.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/config/plan_checks.h"

namespace capstan::cli {

namespace {

ExitCode run(const Invocation& invocation) {
    const config::ReadConfig config = read_config_of(invocation);
    config::require_runnable(config);
    if (!config.plan.compare_with_paper)
        throw InvalidInput(
            {"compare_with_paper: the configuration does not repeat the paper's experiment; use "
             "configs/paper.toml or a variant of it with compare_with_paper = true"});
    RunOptions options;
    options.jobs = static_cast<int>(invocation.integer("jobs"));
    deliver_answer(invocation,
                   answers::paper_estimation_answer(paper::ablate_readings(config.plan, options)));
    return ExitCode::success;
}

}  // namespace

Command paper_estimation_command() {
    return {
        .name = "paper estimation",
        .summary = "Change each reading of the paper's estimation experiment by itself.",
        .description =
            "Runs the paper's estimation experiment as CONFIG has it, and once more with each reading that the "
            "paper leaves open changed by itself: the order in which direction patterns are tried, the instants, "
            "where a single sensor sits, the weights, the stiffness, the rules of the model, the blocked end. Prints "
            "the paper's numbers beside ours with and without each change, so that a reason that the comparison "
            "gives can be checked. Nothing is stored.",
        .arguments = {config_argument},
        .options = {seed_option, repetitions_option, jobs_option, output_option, json_option, help_option},
        .examples = {"capstan paper estimation configs/paper.toml",
                     "capstan paper estimation configs/paper.toml --json -o ablations.json"},
        .run = run};
}

}  // namespace capstan::cli
