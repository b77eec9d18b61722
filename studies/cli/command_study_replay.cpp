#include <fmt/format.h>

#include "capstan/answers/study_answers.h"
#include "capstan/cli/command.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/placement/replay.h"
#include "capstan/placement/stored_study.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

// One of the addresses, from 1; a UsageError says what the study has.
int position(const Invocation& invocation, std::string_view option, std::size_t count) {
    const std::int64_t given = invocation.integer(option);
    if (given > static_cast<std::int64_t>(count)) {
        throw UsageError(
            fmt::format("capstan study replay: --{} is {}, but the study has 1 to {}; `capstan study show` "
                        "lists them",
                        option, given, count));
    }
    return static_cast<int>(given - 1);
}

ExitCode run(const Invocation& invocation) {
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    const StoredStudy stored = load_stored_study(database, id);
    const auto& study = stored.description;
    const ReplayAddress address{
        position(invocation, "scenario", study.scenarios.size()),
        position(invocation, "noise", study.noise_levels.size()),
        position(invocation, "repetition", static_cast<std::size_t>(study.study.repetitions))};
    const Replay replayed = replay(stored.plan, address, static_cast<int>(invocation.integer("jobs")));
    deliver_answer(invocation, answers::replay_answer(replayed, study.scenarios[address.scenario_index],
                                                      study.noise_levels[address.noise_index].label,
                                                      address.repetition + 1));
    return ExitCode::success;
}

}  // namespace

Command study_replay_command() {
    constexpr double most = 1e9;
    return {
        .name = "study replay",
        .summary = "Look at one repetition of a study: readings, estimates, errors.",
        .description =
            "Draws one repetition again, alone, as it ran in the study: the same readings, the same estimates. "
            "Instants, noise levels and repetitions count from 1, as `capstan study show` lists them.",
        .arguments = {study_argument},
        .options = {{.name = "scenario",
                     .kind = OptionKind::integer,
                     .value = "N",
                     .meaning = "Which instant.",
                     .default_value = "1",
                     .low = 1,
                     .high = most},
                    {.name = "noise",
                     .kind = OptionKind::integer,
                     .value = "N",
                     .meaning = "Which noise level.",
                     .default_value = "1",
                     .low = 1,
                     .high = most},
                    {.name = "repetition",
                     .kind = OptionKind::integer,
                     .value = "N",
                     .meaning = "Which repetition.",
                     .default_value = "1",
                     .low = 1,
                     .high = most},
                    database_option,
                    jobs_option,
                    output_option,
                    json_option,
                    help_option},
        .examples = {"capstan study replay --scenario 2 --repetition 17"},
        .run = run};
}

}  // namespace capstan::cli
