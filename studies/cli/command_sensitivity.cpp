#include <fmt/format.h>

#include "capstan/answers/placement_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/watched_run.h"
#include "capstan/config/plan_checks.h"

namespace capstan::cli {

namespace {

ExitCode run_sensitivity(const Invocation& invocation) {
    config::ReadConfig config = config::read_config(invocation.argument("CONFIG"));
    invocation.take("seed", config.plan.seed);
    invocation.take("sensors", config.plan.sensitivity.sensors);
    config::require_runnable(config);
    for (const char* option : {"noise", "sensors"})
        if (invocation.has(option)) refuse_worlds(config.plan, std::string("--") + option);
    if (config.plan.uncertainty.is_stated) {
        std::optional<sensitivity::WorldSensitivity> found;
        watch_table(invocation, config.plan.name, [&](const TableOptions& options) {
            found = sensitivity::vary_worlds(config.plan, options);
        });
        if (!found) return ExitCode::stopped;
        deliver_answer(invocation, answers::world_sensitivity_answer(config.plan, *found));
        return ExitCode::success;
    }
    sensitivity::SensitivityOptions options;
    options.jobs = invocation.count("jobs");
    options.noise_index = noise_index_of(config.plan, invocation);
    ShownWork work(invocation, config.plan.name);
    const auto answer = sensitivity::advice_sensitivity(config.plan, options);
    work.end();
    deliver_answer(invocation, answers::sensitivity_answer(config.plan, answer));
    return ExitCode::success;
}

}  // namespace

Command sensitivity_command() {
    return {
        .name = "sensitivity",
        .summary = "Find which uncertain parameter would change the advice, and at what value.",
        .description =
            "Friction, curvature, stiffness, pretension and noise are never known exactly. For one "
            "number of sensors, this varies each of them within the range that [sensitivity] of CONFIG "
            "gives it. It prints how strongly each parameter affects the error of the best layout (a "
            "Morris screening of all parameters at once), how much worse the advice at the configured "
            "values then is than the best layout, and the value of each parameter alone at which another "
            "layout becomes better. All sets of parameters share their draws. An instant that leaves its "
            "motion regime is replaced by the nearest sample in that regime. With [uncertainty] in CONFIG, it varies "
            "each stated number alone, among them the far end's range and each uncertainty, and prints what "
            "would be advised and which error to expect.",
        .arguments = {config_argument},
        .options = {noise_option,
                    {.name = "sensors",
                     .kind = OptionKind::integer,
                     .value = "N",
                     .meaning =
                         "The number of sensors that the advice is for, instead of the configuration's.",
                     .limits = {1, 64}},
                    seed_option,
                    jobs_option,
                    answer_output_option,
                    page_option,
                    json_option,
                    progress_option,
                    help_option},
        .examples = {"capstan sensitivity configs/paper.toml",
                     "capstan sensitivity my.toml --sensors 2 --html advice.html",
                     "capstan sensitivity configs/noise-sweep.toml",
                     "capstan sensitivity my.toml --json | jq '.parameters[] | {name, flips_above}'"},
        .run = run_sensitivity,
        .time =
            "20 s for configs/paper.toml: some hundred searches as `place` makes, with few repetitions. Shows progress and "
            "the time left.",
        .when_stopped = stores_nothing};
}

}  // namespace capstan::cli
