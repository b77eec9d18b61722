#include <random>

#include "capstan/answers/study_answers.h"
#include "capstan/cli/commands.h"
#include "capstan/cli/common_options.h"
#include "capstan/cli/output.h"
#include "capstan/cli/watched_run.h"
#include "capstan/storage/study_store.h"

namespace capstan::cli {

namespace {

ExitCode run_doctor(const Invocation& invocation) {
    const std::string& file = invocation.text("db");
    ShownWork work(invocation, "reading " + file);
    const answers::DatabaseState state = answers::state_of_database(file);
    work.end();
    deliver_answer(invocation, answers::installation_answer(file, state));
    return state.is_intact ? ExitCode::success : ExitCode::database_problem;
}

}  // namespace

Command doctor_command() {
    return {
        .name = "doctor",
        .summary = "Check the installation and the integrity of the database.",
        .description =
            "Checks the program, the processor and the optional programs, reads every page of the "
            "database, checks every reference in it, and compares every content hash, so that a changed number "
            "is found and its study, unit and table are named. Changes nothing.",
        .options = {database_option, output_option, json_option, progress_option, help_option},
        .examples = {"capstan doctor", "capstan doctor --db other.db --json"},
        .run = run_doctor,
        .time = "About half a minute for a gigabyte of the database. Shows progress and the time left."};
}

namespace {

ExitCode run_study_verify(const Invocation& invocation) {
    storage::Database database = storage::Database::open_read_only(invocation.text("db"));
    const std::int64_t id = storage::find_study(database, invocation.argument("STUDY"));
    use_simd_of(invocation, storage::read_computations(database, id));
    Sample sample{invocation.number("share"), std::random_device()()};
    invocation.take("seed", sample.seed);
    Recomputation found;
    reports::Answer answer;
    const ExitCode code = watch(invocation, "verification", [&](const RunOptions& options) -> WatchedEnd {
        found = recompute(database, id, sample, options);
        answer = answers::verification_answer(id, sample, found);
        const bool stopped = found.end == RunEnd::stopped;
        return {found.end, {}, stopped ? "Stopped; nothing was compared." : answer.headline, id};
    });
    if (code != ExitCode::success) return code;
    deliver_answer(invocation, answer);
    return found.problems.empty() ? ExitCode::success : ExitCode::database_problem;
}

}  // namespace

Command study_verify_command() {
    return {
        .name = "study verify",
        .summary = "Compute part of a study again and compare.",
        .description =
            "Computes a random part of a stored study's units again, with the vector instructions that it was "
            "computed with, and compares every stored number bit by bit. Names each unit and table that "
            "differs. Changes nothing. `capstan doctor` compares the content hashes of all units, which finds "
            "damage, but not a wrong computation.",
        .arguments = {study_argument},
        .options = {database_option,
                    {.name = "share",
                     .kind = OptionKind::number,
                     .value = "FRACTION",
                     .meaning = "Fraction of the units; at least one is computed.",
                     .default_value = "0.05",
                     .limits = {1e-9, 1.0}},
                    {.name = "seed",
                     .kind = OptionKind::integer,
                     .value = "S",
                     .meaning = "Seed of the choice; by default another one each time.",
                     .limits = {0, 9.2e18}},
                    jobs_option,
                    simd_option,
                    output_option,
                    json_option,
                    progress_option,
                    help_option},
        .examples = {"capstan study verify", "capstan study verify paper --db paper.db --share 1"},
        .run = run_study_verify,
        .when_stopped = stores_nothing};
}

}  // namespace capstan::cli
