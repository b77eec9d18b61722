#include <fmt/format.h>

#include "capstan/answers/placement_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/placement/prepared_study.h"
#include "capstan/placement/recommendation.h"
#include "capstan/placement/stored_study.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

ExitCode run_recommend(const Invocation& invocation) {
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    const StoredStudy stored = load_stored_study(database, id);
    if (stored.plan.uncertainty.is_stated) {
        StudyPlan plan = stored.plan;
        invocation.take("worthwhile-gain", plan.worthwhile_gain_N);
        deliver_answer(invocation, answers::stored_world_answer(database, id, plan));
        return ExitCode::success;
    }
    answers::Conclusions conclusions = answers::read_conclusions(database, id);
    if (invocation.has("worthwhile-gain")) {
        conclusions.recommendations =
            recommend(database, id, {invocation.number("worthwhile-gain"), no_sensor_errors_N(stored.plan)},
                      independent_errors(database, id, stored.plan, invocation.count("jobs")));
    }
    deliver_answer(invocation, answers::recommendation_answer(conclusions, stored.plan));
    return ExitCode::success;
}

}  // namespace

Command recommend_command() {
    return {
        .name = "recommend",
        .summary = "Recommend which sensors to use, where, and how to fuse them.",
        .description =
            "Prints the recommendations of a study for each noise level: for each motion regime, across "
            "all regimes (minimax regret), and over the duty cycle. Each has a 95% interval and lists "
            "the choices with as many sensors that are not significantly worse. The study's draws are optimistic about the best of "
            "many layouts, so its error is re-estimated on independent draws, and the optimism is "
            "stated. Studies of the paper's experiment also show the paper's numbers beside ours.",
        .arguments = {study_argument},
        .options =
            {{.name = "worthwhile-gain",
              .kind = OptionKind::number,
              .value = "N",
              .meaning =
                  "One more sensor must lower the error by at least N newtons; replaces the study's own "
                  "threshold.",
              .limits = {0, 1e6}},
             database_option,
             jobs_option,
             output_option,
             json_option,
             help_option},
        .examples = {"capstan recommend", "capstan recommend paper --worthwhile-gain 0.05",
                     "capstan recommend --json -o recommendation.json"},
        .run = run_recommend};
}

}  // namespace capstan::cli
