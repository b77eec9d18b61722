#include <fmt/format.h>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/watched_run.h"
#include "capstan/placement/study_merge.h"

namespace capstan::cli {

namespace {

ExitCode run_study_merge(const Invocation& invocation) {
    const std::string& file = invocation.text("db");
    const auto& names = invocation.repeated_argument();
    const std::vector<std::filesystem::path> shards(names.begin(), names.end());
    return watch(invocation, "merge", [&](const RunOptions& options) -> WatchedEnd {
        const RunEnd end = merge_shards(file, shards, options);
        const std::string words =
            end == RunEnd::complete
                ? fmt::format("Merged {} into {}; `capstan recommend --db {}` shows the recommendation.",
                              shards.size() == 1 ? "1 shard" : fmt::format("{} shards", shards.size()), file,
                              file)
                : "Stopped; nothing was written, and the shards are as they were.";
        return {end, {}, words, 0};
    });
}

}  // namespace

Command study_merge_command() {
    return {.name = "study merge",
            .summary = "Join the shards of a study.",
            .description =
                "Joins the files written by `capstan study run --shard` into a new database and computes the "
                "recommendations. Every table has the same bits as after one run. Every shard must be given "
                "once, be finished, and belong to the same study. Otherwise nothing is written, and every "
                "missing, repeated, foreign or unfinished shard is named.",
            .arguments = {{"SHARD", "The files of all shards, in any order.", ArgumentNeed::one_or_more}},
            .options = {{.name = "db",
                         .kind = OptionKind::string,
                         .value = "FILE",
                         .meaning = "The new database; it is written completely or not at all.",
                         .default_value = "capstan.db"},
                        jobs_option,
                        progress_option,
                        help_option},
            .examples = {"capstan study merge --db atlas.db shard-*.db"},
            .run = run_study_merge,
            .can_be_stopped = true};
}

}  // namespace capstan::cli
