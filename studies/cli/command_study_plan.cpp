#include <algorithm>

#include "capstan/answers/study_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/watched_run.h"
#include "capstan/config/plan_checks.h"
#include "capstan/placement/study_cost.h"
#include "capstan/placement/study_shard.h"

namespace capstan::cli {

namespace {

// Shards of a few minutes: a failed one costs little, and the start of one takes little of its time.
int sensible_shards(const StudyCost& cost) {
    constexpr double shard_s = 300.0;
    return std::clamp(static_cast<int>(cost.processor_s / shard_s), 1, cost.parts);
}

ExitCode run_study_plan(const Invocation& invocation) {
    const config::ReadConfig config = read_config_of(invocation);
    const std::vector<StudyPlan> plans = config::runnable_studies(config);
    refuse_worlds(config.plan, "study plan");
    if (invocation.has("shards")) require_useful(plans, {1, invocation.count("shards")});
    ShownWork work(invocation, config.plan.name);
    const StudyCost cost = predict_cost(plans, {invocation.number("seconds")});
    work.end();
    const int shards = invocation.has("shards") ? invocation.count("shards") : sensible_shards(cost);
    deliver_answer(invocation, answers::cost_answer(config.plan.name, cost, plans, shards));
    return ExitCode::success;
}

}  // namespace

Command study_plan_command() {
    return {
        .name = "study plan",
        .summary = "Estimate the run time of a study before it starts.",
        .description =
            "Counts the work of CONFIG and predicts its processor time on this machine, alone and in "
            "shards, and the width of its intervals. The prediction uses a pilot: some parts of the "
            "study on one processor with few repetitions. The time to store results is not included. "
            "Nothing is written.",
        .arguments = {config_argument},
        .options =
            {{.name = "shards",
              .kind = OptionKind::integer,
              .value = "N",
              .meaning = "Number of shards to predict for. Default: shards of about five minutes each.",
              .limits = {1, 1e6}},
             {.name = "seconds",
              .kind = OptionKind::number,
              .value = "S",
              .meaning =
                  "Processor time of the pilot; more time gives a better prediction. At least one part of each "
                  "cable length is timed.",
              .default_value = "5",
              .limits = {0, 1e5}},
             seed_option,
             repetitions_option,
             output_option,
             json_option,
             progress_option,
             help_option},
        .examples = {"capstan study plan configs/atlas.toml",
                     "capstan study plan configs/atlas.toml --shards 100 --json"},
        .run = run_study_plan,
        .time =
            "The --seconds of its pilot, and the true motion of every study of the sweep: 10 s for configs/atlas.toml. Shows "
            "progress and the time left."};
}

}  // namespace capstan::cli
