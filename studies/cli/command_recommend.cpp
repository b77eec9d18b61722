#include <fmt/format.h>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/json_text.h"
#include "capstan/cli/output.h"
#include "capstan/cli/recommendation_words.h"
#include "capstan/placement/recommendation.h"
#include "capstan/placement/stored_study.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

ExitCode run(const Invocation& invocation) {
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    Conclusions conclusions = read_conclusions(database, id);
    if (invocation.has("worthwhile-gain")) {
        const StoredStudy stored = load_stored_study(database, id);
        conclusions.recommendations =
            recommend(database, id, {invocation.real("worthwhile-gain")},
                      fresh_errors(database, id, stored.plan, static_cast<int>(invocation.whole("jobs"))));
    }
    deliver(invocation, invocation.has("json") ? json_text(in_json(conclusions)) : in_words(conclusions));
    return ExitCode::success;
}

}  // namespace

Command recommend_command() {
    return {
        "recommend",
        "Say which sensors to use, where, and how to fuse them.",
        "Says what follows from a study, per noise level: for each motion regime, to be safe in every regime "
        "(minimax regret), and over the duty cycle; each with its interval and the choices that are as good. The best of "
        "many looks better than it is on the draws that chose it, so its error is that of fresh draws, and how much the "
        "choice flattered it is said. "
        "Studies that repeat the paper's experiment show its numbers beside ours.",
        {study_argument},
        {{"worthwhile-gain",
          '\0',
          OptionKind::real_number,
          "N",
          "One more sensor must lower the error by this much, in newtons; instead of the study's own.",
          "",
          {},
          0,
          1e6},
         database_option,
         jobs_option,
         output_option,
         json_option,
         help_option},
        {"capstan recommend", "capstan recommend paper --worthwhile-gain 0.05",
         "capstan recommend --json -o recommendation.json"},
        run};
}

}  // namespace capstan::cli
