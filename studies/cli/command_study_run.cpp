#include <fmt/format.h>

#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/config_reader.h"
#include "capstan/cli/config_writer.h"
#include "capstan/cli/program.h"
#include "capstan/cli/watched_run.h"

namespace capstan::cli {

namespace {

// The stored configuration is that of the study as it ran, options of the command line included.
void override_from(const Invocation& invocation, StudyPlan& plan) {
    if (invocation.has("seed")) plan.seed = static_cast<std::uint64_t>(invocation.whole("seed"));
    if (invocation.has("repetitions")) plan.repetitions = static_cast<int>(invocation.whole("repetitions"));
    plan.config_toml = config_text(plan, Comments::none);
}

ExitCode run(const Invocation& invocation) {
    ReadConfig config = read_config(invocation.argument("CONFIG"));
    override_from(invocation, config.plan);
    require_runnable(config);
    storage::Database database = storage::Database::open_or_create(invocation.text("db"));
    return run_watched(invocation, database, config.plan.name, [&](const RunOptions& options) {
        return run_study(database, config.plan, program_version(), options);
    });
}

}  // namespace

Command study_run_command() {
    std::vector<Option> options = watched_run_options();
    options.insert(options.begin() + 2, {seed_option, repetitions_option});
    return {
        "study run",
        "Run a study and recommend sensors.",
        "Runs the study that CONFIG describes, stores it in the results database, and says which sensors to use, "
        "where, and how to fuse them. A database holds any number of studies. Ctrl-C stops after the unit under "
        "way, and even a killed run loses no more than that unit: `capstan study resume` goes on, to the same bits.",
        {config_argument},
        std::move(options),
        {"capstan study run configs/quick.toml", "capstan study run configs/paper.toml --db paper.db --stats",
         "capstan study run my.toml --repetitions 50 --json | jq .recommendations"},
        run};
}

}  // namespace capstan::cli
